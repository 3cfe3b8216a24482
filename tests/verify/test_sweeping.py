"""`make verify`: a sweep on a disk that is full."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.full

ROOT = Path(__file__).parents[2]
PLAN = """
experiment = "fusion"
views = 600
[set]
"map.charts" = 120
"camera.width" = 90
"camera.height" = 15
[grid]
"nose.noise" = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]
"""


def run(plan: Path, out: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "cogmap", "sweep", plan, "--out", out, "--workers", "1", "--json"]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


def points(out: Path) -> dict[str, tuple[int, int]]:
    """Finished points, by inode and time of their last change."""
    files = sorted((out / "points").glob("*.json"))
    return {one.name: (one.stat().st_ino, one.stat().st_mtime_ns) for one in files}


def test_disk_that_is_full(small_disk: Path, tmp_path: Path) -> None:
    plan, usual, out = tmp_path / "sweep.toml", tmp_path / "usual", small_disk / "swept"
    plan.write_text(PLAN, encoding="utf-8")
    assert run(plan, usual).returncode == 0
    failed = run(plan, out)
    sys.stdout.write(failed.stderr)
    assert failed.returncode == 2
    assert failed.stdout == ""
    (sentence,) = failed.stderr.splitlines()
    assert "there is no space left on a disk; all points that are finished are kept" in sentence
    kept = points(out)
    assert 0 < len(kept) < 6
    subprocess.run(["mount", "-o", "remount,size=200m", str(small_disk)], check=True)  # noqa: S607
    again = run(plan, out)
    assert again.returncode == 0, again.stderr
    assert {name: points(out)[name] for name in kept} == kept
    assert json.loads(again.stdout)["rows"] == 6
    assert (out / "table.csv").read_bytes() == (usual / "table.csv").read_bytes()
