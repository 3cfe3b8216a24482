"""`make verify`: the experiments of the paper at full size, each figure with its bar beside it."""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.full

BARS: dict[str, list[tuple[str, str, Any]]] = {
    "rotation": [
        ("test_correlation", "≥", 0.998),
        ("median_error_deg", "≤", 0.7),
        ("betti", "=", [1, 1, 0]),
        ("dimension", "≈", 1),
    ],
    "cyclic": [
        ("heading_resultant", "≥", 0.98),
        ("translation_r2", "≥", 0.95),
        ("betti", "=", [1, 1, 0]),
        ("dimension", "≈", 2),
    ],
    "brownian": [
        ("position_r2", "≥", 0.95),
        ("heading_resultant", "≥", 0.99),
        ("betti", "=", [1, 1, 0]),
        ("dimension", "≈", 3),
    ],
    "localisation": [("position_median_m", "≤", 0.05), ("heading_median_deg", "≤", 0.8)],
    "roadmap": [
        ("success", "≥", 1.0),
        ("length_ratio_median", "≤", 1.5),
        ("paths_touching", "≤", 0.1),
        ("deviation_ratio", "≤", 2),
        ("query_ms", "≤", 50),
    ],
    "distinguishability": [
        ("confusion_white", "≥", 0.4),
        ("confusion_white", "≤", 0.6),
        ("confusion_blue_wall", "≤", 0.02),
    ],
    "fusion": [
        ("vision_only/place_cells_passing", "=", 0),
        ("vision_only/heading_cells_passing", "=", 0),
        ("vision_only/in_field_direction_vector", "≥", 0.9),
        ("olfaction_only/heading_cells_passing", "=", 0),
        ("olfaction_only/position_median_m", "≥", 0.12),
        ("fused/place_cells_passing", "≥", 0.95),
        ("fused/heading_cells_passing", "≥", 0.95),
        ("fused/position_median_m", "≤", 0.055),
        ("fused/position_p95_m", "≤", 0.15),
        ("fused/heading_median_deg", "≤", 2.5),
        ("fused/metric_map_r2", "≥", 0.99),
        ("competition/cue_square/with_smell/trusted", "=", True),
        ("competition/cue_square/with_smell/heading_median_deg", "≤", 2.0),
        ("competition/cue_square/with_smell/position_median_m", "≤", 0.04),
        ("competition/cue_square/sight_alone/trusted", "=", False),
    ],
    "slow_features": [
        ("brownian/slow_features/place_cells_passing", "≥", 0.8),
        ("brownian/slow_features/heading_cells_passing", "=", 0),
        ("slow_turning/slow_features/place_cells_passing", "=", 0),
        ("slow_turning/slow_features/heading_cells_passing", "≥", 0.6),
        ("shuffled/slow_features/place_cells_passing", "=", 0),
        ("shuffled/slow_features/heading_cells_passing", "=", 0),
        *[
            (f"{walk}/fused/{kind}_cells_passing", "≥", 0.95)
            for walk in ("brownian", "slow_turning", "shuffled")
            for kind in ("place", "heading")
        ],
        ("shuffled/fused/position_median_m", "≤", 0.055),
        ("shuffled/fused/heading_median_deg", "≤", 3),
        ("shuffled/fused/heading_resultant", "≥", 0.996),
    ],
    "odour_ablation": [
        ("2_sources_0.1_noise/place_position_median_m", "≤", 0.13),
        ("2_sources_0.1_noise/place_position_p95_m", "≤", 0.4),
        ("2_sources_0.1_noise/single_field", "≥", 0.85),
        *[(f"3_sources_{noise}_noise/place_cells_passing", "≥", 0.9) for noise in ("0", "0.1", "0.2", "0.3")],
    ],
    "acuity": [
        ("90_columns_3000_charts/heading_median_deg", "≤", 3),
        ("360_columns_3000_charts/heading_median_deg", "≤", 2.5),
        ("360_columns_375_charts/heading_resultant", "≥", 0.98),
    ],
    "darkness": [
        ("map_correlation", "≥", 0.8),
        ("sight/place_cells_passing", "≥", 0.95),
        ("sight/heading_cells_passing", "≥", 0.95),
        ("smell/place_cells_passing", "≥", 0.9),
        ("smell/heading_cells_passing", "=", 0),
    ],
    "cue_rotation": [
        ("place_follows_walls_light", "≥", 0.95),
        ("place_follows_walls_dark", "≤", 0.05),
        ("heading_follows_walls", "≥", 0.95),
        ("heading_shift_deg", "≥", 85),
        ("heading_shift_deg", "≤", 95),
    ],
    "cue_card": [
        *[
            (f"{room}/{key}", sign, bar)
            for room in ("cue_square", "cue_cylinder")
            for key, sign, bar in (
                ("trusted", "=", True),
                ("light/place_follows_card", "≥", 0.95),
                ("light/heading_follows_card", "≥", 0.95),
                ("light/heading_shift_deg", "≥", 85),
                ("light/heading_shift_deg", "≤", 95),
                ("dark/place_follows_card", "≤", 0.05),
            )
        ]
    ],
    "development": [
        ("driven/place_cells_passing", "≥", 0.95),
        ("driven/heading_cells_passing", "≥", 0.95),
        ("views_to_mature/heading", "≤", 3000),
        ("views_to_mature/place", "≤", 10_000),
        ("smell_first/trusted", "=", True),
        ("smell_first/views_to_mature_in_the_dark", "≤", 3000),
        ("smell_first/views_to_mature/heading", "≤", 3000),
        ("smell_first/views_to_mature/place", "≤", 10_000),
    ],
    "goals": [
        ("ring_betti", "=", [1, 1]),
        ("place_cells_passing", "≥", 0.9),
        ("heading_cells_passing", "≥", 0.9),
        ("heading_median_deg", "≤", 5),
    ],
    "directionality": [
        ("open_field/fused/directional", "≤", 0.05),
        ("open_field/fused/in_field_direction_vector", "≤", 0.1),
        ("corridor/fused/directional", "≥", 0.9),
        ("open_field/vision_only/directional", "≥", 0.95),
        ("corridor/vision_only/directional", "≥", 0.95),
    ],
}
"""Of each experiment: where in its metrics, and what must hold there."""
ELSEWHERE = [
    (name, room)
    for name, home in (("brownian", "furnished"), ("localisation", "furnished"), ("roadmap", "obstacles"))
    for room in ("open_field", "furnished", "obstacles")
    if room != home
]
"""Rooms in which these experiments say how they do, without a bar."""


def conduct(name: str, out: Path, *options: object) -> dict[str, Any]:
    command = [sys.executable, "-m", "cogmap", "experiment", name, "--out", out, "--json", *map(str, options)]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    found: dict[str, Any] = json.loads(run.stdout)
    return found


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize("name", BARS)
def test_experiment(name: str, seed: int, tmp_path: Path, judge: Callable[..., None]) -> None:
    judge(f"{name} seed {seed}", conduct(name, tmp_path / name, "--seed", seed), BARS[name])


@pytest.mark.parametrize(("name", "room"), ELSEWHERE)
def test_other_rooms(name: str, room: str, tmp_path: Path) -> None:
    found = conduct(name, tmp_path / name, "--arena", room)
    said = {key: value for key, value in found.items() if isinstance(value, int | float | list)}
    sys.stdout.write("".join(f"{name} in {room}: {key} {value}\n" for key, value in said.items()))
    assert found["arena"] == room
