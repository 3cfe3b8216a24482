"""`make verify`: speed and memory, each figure with its bar beside it."""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.full

ROOT = Path(__file__).parents[2]
BARS: dict[str, list[tuple[str, str, Any]]] = {
    "rendering": [
        ("perspective_320x240_over_vizdoom_one_core/ratio", "≥", 2),
        ("perspective_two_threads_over_one/ratio", "≥", 1.7),
        ("perspective_400_surfaces_cost", "≤", 1.7),
        ("panoramic_400_surfaces_cost", "≤", 3),
        ("panoramic_360x60/frames_per_s", "≥", 12_000),
    ],
    "exploring": [("one_core/disk/views_per_s", "≥", 2500)],
    "stepping": [("ratio", "≥", 10)],
    "learning": [("map/seconds", "≤", 15), ("map/over_slow_features", "≤", 1)],
    "streaming": [
        ("views", "=", 1_000_000),
        ("seconds", "≤", 480),
        ("peak_over_before_bytes", "≤", 10**9),
        ("peak_risen_in_last_tenth_bytes", "≤", 2 * 10**7),
        ("late_over_early", "≤", 1.1),
    ],
    "evaluating": [("place_cells/ratio", "≥", 10)],
    "manifold": [
        ("bag_of_words_over_sift_per_core", "≤", 1.25),
        ("isomap_speed_over_sklearn", "≥", 10),
        ("isomap_memory_over_sklearn", "≤", 0.25),
        ("isomap_correlation_below_sklearn", "≤", 0.002),
    ],
    "sweeping": [
        ("efficiency_waiting", "≥", 0.85),
        ("efficiency_computing", "≥", 0.85),
        ("efficiency_fusion", "≥", 0.85),
    ],
}


@pytest.mark.parametrize("subject", BARS)
def test_benchmark(subject: str, judge: Callable[..., None]) -> None:
    command = [sys.executable, "-m", "benchmarks", subject]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    sys.stdout.write(run.stderr)
    judge(subject, json.loads(run.stdout)[subject], BARS[subject])
