"""`make verify`: what an explorer does with its map, each figure with its bar."""

from pathlib import Path

import pytest

from arena import Arena
from cogmap.experiments.registry import run_experiment

pytestmark = pytest.mark.full

ROOMS = ("furnished", "open_field", "pillar", "obstacles", "l_shape")
SEEDS = (0, 1, 2)
DISTURBED = ("pillar", "obstacles")
DISTURBANCES = ("slip", "swapped", "weak", "delayed")
TOUCHING = {"l_shape": 0.05}
"""Share of ways with a contact, where it may be more than .02."""
LEAST = {
    "imagination": {"psnr_median_db": 38, "psnr_p05_db": 29, "ssim_mean": 0.985, "replay_r2": 0.95},
    "expectation": {"ahead_psnr_db": 34},
    "surprise": {"auc_moved": 0.96, "auc_added": 0.96, "auc_removed": 0.96},
    "reaching": {"within_5cm_2deg": 0.98, "within_2cm_1deg": 0.9},
}
MOST = {
    "imagination": {
        "dream_position_median_m": 0.004,
        "dream_heading_median_deg": 0.06,
        "outside_position_median_m": 0.02,
        "outside_heading_median_deg": 0.8,
        "blend_ms": 5,
        "warp_ms": 60,
    },
    "expectation": {},
    "surprise": {"located_median_m": 0.25, "false_alarms": 10},
    "reaching": {"path_ratio_median": 1.15},
}
OF_THEIR_OWN = {
    "dynamics": {
        "least": {"journeys": 100, "stopped_within_3cm": 0.95, "ahead_1s_psnr_db": 28},
        "most": {"babbling_s": 10},
    },
    "looking_round": {
        "least": {"blue_wall_share_right_after": 0.99, "white_share_right_after": 0.44},
        "most": {
            "blue_wall_turned_median_deg": 30 + 1e-9,
            "blue_wall_resolved_and_wrong": 0,
            "white_share_right_after": 0.56,
            "white_share_resolved": 0,
        },
    },
}
"""Bars of experiments in the room that they were made for."""
RELAXED = {"relaxed_position_median_m": 0.018, "relaxed_heading_median_deg": 0.7}
"""At most, in `furnished`."""


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("room", ROOMS)
@pytest.mark.parametrize("name", sorted(MOST))
def test_it_reaches_the_bar(name: str, room: str, seed: int, tmp_path: Path) -> None:
    metrics = run_experiment(name, tmp_path / name, room=Arena.load(room), seed=seed).metrics
    least, most = dict[str, float](LEAST[name]), dict[str, float](MOST[name])
    if name == "imagination" and room == "furnished":
        most |= RELAXED
    if name == "reaching":
        most["touching"] = TOUCHING.get(room, 0.02)
        if room in DISTURBED:
            least |= {f"{disturbance}_within_5cm_2deg": 0.95 for disturbance in DISTURBANCES}
    print(name, room, seed, *(f"{key}={value}" for key, value in sorted(metrics.items())))  # noqa: T201
    assert not missed(metrics, least, most)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", sorted(OF_THEIR_OWN))
def test_it_reaches_the_bar_in_its_own_room(name: str, seed: int, tmp_path: Path) -> None:
    metrics = run_experiment(name, tmp_path / name, seed=seed).metrics
    print(name, seed, *(f"{key}={value}" for key, value in sorted(metrics.items())))  # noqa: T201
    assert not missed(metrics, **OF_THEIR_OWN[name])


def missed(metrics: dict[str, float], least: dict[str, float], most: dict[str, float]) -> list[str]:
    """Say which figures are beyond their bars."""
    below = [f"{key} {metrics[key]:g} < {bar:g}" for key, bar in least.items() if metrics[key] < bar]
    return below + [f"{key} {metrics[key]:g} > {bar:g}" for key, bar in most.items() if metrics[key] > bar]
