"""A stream of 200,000 views at constant memory and constant time per view."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.full

ROOT = Path(__file__).parents[2]
VIEWS, MOST_BYTES, MOST_RISEN, MOST_SLOWED = 200_000, 10**9, 2 * 10**7, 1.3


def test_memory_and_time_do_not_depend_on_what_came_before() -> None:
    command = [sys.executable, "-m", "benchmarks", "streaming"]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    found = json.loads(run.stdout)["streaming"]
    sys.stdout.write("".join(f"{name} {value}\n" for name, value in found.items()))
    assert found["views"] == VIEWS
    assert found["peak_over_before_bytes"] <= MOST_BYTES
    assert found["peak_risen_in_last_tenth_bytes"] <= MOST_RISEN
    assert found["late_over_early"] <= MOST_SLOWED
