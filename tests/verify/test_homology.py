"""`make verify`: the holes of all that a map knows, in five rooms and from three walks each."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.full

SEEDS = (0, 1, 2)
LEAST = 54
"""Of 60 that are resolved."""
EXPECTED = {
    "open_field": ([1, 1, 0], [1, 1], [1, 0], [1, 1]),
    "furnished": ([1, 1, 0], [1, 1], [1, 0], [1, 1]),
    "pillar": ([1, 2, 1], [1, 2], [1, 1], [1, 1]),
    "two_pillars": ([1, 3, 2], [1, 3], [1, 2], [1, 1]),
    "l_shape": ([1, 1, 0], [1, 1], [1, 0], [1, 1]),
}
CLOUDS = ("view_manifold", "fused", "place", "heading")


def run(seed: int, out: Path) -> dict[str, Any]:
    command = [sys.executable, "-m", "cogmap", "experiment", "homology", "--out", out, "--json"]
    run = subprocess.run([*command, "--seed", str(seed)], capture_output=True, text=True, check=True)
    found: dict[str, Any] = json.loads(run.stdout)
    return found


def test_all_cases_are_right_and_most_resolved(tmp_path: Path) -> None:
    right, nerves, resolved = [], [], []
    for seed in SEEDS:
        rooms = run(seed, tmp_path / str(seed))["rooms"]
        assert rooms.keys() == EXPECTED.keys()
        for room, numbers in EXPECTED.items():
            for cloud, wanted in zip(CLOUDS, numbers, strict=True):
                told = rooms[room][cloud]
                right.append(told["betti"][: len(wanted)] == wanted)
                resolved.append(all(told["resolved"][: len(wanted)]))
                if "nerve" in told:
                    nerves.append(told["nerve"] == wanted)
                sys.stdout.write(
                    f"seed {seed}, {room}, {cloud}: {told['betti']} of {wanted}, votes {told['votes']}, "
                    f"unresolved {told['unresolved_because']}, "
                    f"margin {told['margin']:.2f}, nerve {told.get('nerve', 'not asked')}\n"
                )
    sys.stdout.write(f"{sum(right)} of {len(right)} right, {sum(resolved)} resolved\n")
    sys.stdout.write(f"nerves {sum(nerves)} of {len(nerves)}\n")
    assert len(right) == 60
    assert sum(right) == 60
    assert sum(resolved) >= LEAST
