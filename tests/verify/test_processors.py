"""`make portable`: what learns, explores or resumes passes its tests on every simulated processor."""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.processors import PROCESSORS, processor

pytestmark = pytest.mark.full

ROOT = Path(__file__).parents[2]
TESTS = (
    "tests/neurons",
    "tests/arena/motions",
    "tests/arena/test_exploration.py",
    "tests/cogmap/map",
    "tests/cogmap/experiments",
    "tests/cogmap/sweeps",
    "tests/notebooks",
    "tests/test_readme.py",
)


@pytest.mark.parametrize("name", [*PROCESSORS, "portable"])
def test_what_learns_explores_or_resumes_passes(name: str, tmp_path: Path) -> None:
    environment = None if name == "portable" else processor(name, tmp_path)
    if environment is None and name != "portable":
        pytest.skip(f"this processor has no instructions of {name}")
    before = [sys.executable, "-m", "cogmap", "portable"] if name == "portable" else []
    tests = [sys.executable, "-m", "pytest", "-q", "--numprocesses", "auto", "--dist", "loadfile", *TESTS]
    done = subprocess.run([*before, *tests], cwd=ROOT, env=environment, check=False)
    assert done.returncode == 0
