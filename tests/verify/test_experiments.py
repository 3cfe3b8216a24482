"""`make verify`: the experiments of the paper at full size, each figure with its bar beside it."""

import json
import subprocess
import sys
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
}
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


def holds(found: Any, sign: str, bar: Any) -> bool:
    if sign in "=≈":
        return bool((round(found) if sign == "≈" else found) == bar)
    least, most = (min(found), max(found)) if isinstance(found, list) else (found, found)
    return bool(least >= bar if sign == "≥" else most <= bar)


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize("name", BARS)
def test_experiment(name: str, seed: int, tmp_path: Path) -> None:
    found = conduct(name, tmp_path / name, "--seed", seed)
    lines = [(holds(found[key], sign, bar), key, found[key], sign, bar) for key, sign, bar in BARS[name]]
    table = "\n".join(f"{name} seed {seed}: {key} {value} {sign} {bar}" for _, key, value, sign, bar in lines)
    sys.stdout.write(table + "\n")
    assert all(line[0] for line in lines), table


@pytest.mark.parametrize(("name", "room"), ELSEWHERE)
def test_other_rooms(name: str, room: str, tmp_path: Path) -> None:
    found = conduct(name, tmp_path / name, "--arena", room)
    said = {key: value for key, value in found.items() if isinstance(value, int | float | list)}
    sys.stdout.write("".join(f"{name} in {room}: {key} {value}\n" for key, value in said.items()))
    assert found["arena"] == room
