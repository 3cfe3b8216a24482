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
        ("perspective_320x240_over_vizdoom/ratio_median", "≥", 2.5),
        ("panoramic_360x60/ratio", "≥", 0.07),
        ("strip_90x15/ratio", "≥", 0.011),
        ("perspective_320x240_few_surfaces/ratio", "≤", 1.7),
        ("panoramic_360x60_few_surfaces/ratio", "≤", 3),
        ("two_threads/ratio", "≥", 1.7),
    ],
    "exploring": [
        ("one_core/disk/per_s", "≥", 2500),
        ("all_cores/memory/per_s", "≥", 8000),
        ("all_cores/memory/ratio", "≥", 0.6),
    ],
    "stepping": [("explorer/ratio", "≥", 12), ("explorers/ratio", "≥", 1.6)],
    "learning": [
        ("retina/per_s", "≥", 20_000),
        ("retina/ratio", "≥", 0.15),
        ("map/seconds", "≤", 7),
        ("map/ratio", "≥", 2),
        ("perceive/per_s", "≥", 10_000),
    ],
    "homology": [("betti/seconds", "≤", 4), ("paths_equal_scipy", "=", 1)],
    "demonstrating": [
        ("demo/seconds", "≤", 40),
        ("demo/peak_memory_bytes", "≤", 1_500_000_000),
        ("compilation/seconds", "≤", 8),
    ],
    "living": [("click_median_ms", "≤", 100), ("click_p95_ms", "≤", 100), ("driven_hz", "≥", 20)],
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
