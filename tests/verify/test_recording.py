"""`make verify`: recordings at full size, killed, within memory, on a disk that is full."""

import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy as np
import pytest

from arena.recordings.sharding import file, is_complete, shards

pytestmark = pytest.mark.full

ROOT = Path(__file__).parents[2]
KILLS, VIEWS, HUNDRED_THOUSAND = 20, 20_000, 100_000
MOST_BYTES = 10**9


def command(out: Path, views: int) -> list[str]:
    return [sys.executable, "-m", "cogmap", "explore", "furnished", "--views", str(views), "--out", str(out)]


def run(out: Path, views: int = VIEWS) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command(out, views), cwd=ROOT, capture_output=True, text=True, check=False)


def content(path: Path) -> dict[str, str]:
    files = (found for found in path.rglob("*") if found.is_file())
    return {str(one.relative_to(path)): hashlib.sha256(one.read_bytes()).hexdigest() for one in files}


def complete(path: Path) -> dict[str, tuple[int, int]]:
    """Which shards are whole, by inode and time of their last change."""
    found = [file(path / "views", rows) for rows in shards(VIEWS) if is_complete(path / "views", rows)]
    return {str(one): (one.stat().st_ino, one.stat().st_mtime_ns) for one in found}


def test_killed_twenty_times(tmp_path: Path) -> None:
    assert run(tmp_path / "whole.zarr").returncode == 0
    wanted, rows = content(tmp_path / "whole.zarr"), shards(VIEWS)
    assert len([name for name in wanted if name.startswith("views/c/")]) == len(rows)
    rng = np.random.default_rng()
    for kill in range(KILLS):
        path = tmp_path / f"{kill}.zarr"
        awaited = file(path / "views", rows[rng.integers(len(rows) - 1)])
        with subprocess.Popen(command(path, VIEWS), cwd=ROOT, stdout=subprocess.DEVNULL) as victim:
            while not awaited.exists():
                assert victim.poll() is None
                time.sleep(0.001)
            time.sleep(rng.uniform(0, 0.1))
            victim.send_signal(signal.SIGKILL)
        before = complete(path)
        again = run(path)
        assert again.returncode == 0, again.stderr
        after = complete(path)
        untouched = {name: after[name] for name in before} == before
        identical = content(path) == wanted
        sys.stdout.write(
            f"kill {kill + 1} when {len(before)} of {len(rows)} shards were whole: "
            f"these untouched {untouched}, all bit-identical in the end {identical}\n"
        )
        assert untouched
        assert identical
        shutil.rmtree(path)


def test_memory_of_a_hundred_thousand_views(tmp_path: Path) -> None:
    script = """
        import sys
        from arena import Arena, Brownian, Camera, explore
        _, out, views = sys.argv
        explore(Arena.load("furnished"), Brownian(), Camera.perspective(), views=int(views), out=out)
    """
    started = time.perf_counter()
    arguments = [sys.executable, "-c", textwrap.dedent(script), str(tmp_path / "rec"), str(HUNDRED_THOUSAND)]
    with subprocess.Popen(arguments, cwd=ROOT) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    peak = 1024 * usage.ru_maxrss
    seconds = time.perf_counter() - started
    size = sum(one.stat().st_size for one in (tmp_path / "rec").rglob("*") if one.is_file())
    sys.stdout.write(
        f"{HUNDRED_THOUSAND} views of 320x240 in {seconds:.0f} s, {size / 1e9:.2f} GB on disk: "
        f"peak {peak / 1e9:.3f} ≤ {MOST_BYTES / 1e9:g} GB of memory\n"
    )
    shutil.rmtree(tmp_path / "rec")
    assert process.returncode == 0
    assert peak <= MOST_BYTES


def test_disk_that_is_full(small_disk: Path, tmp_path: Path) -> None:
    views = 2000
    assert run(tmp_path / "whole.zarr", views).returncode == 0
    failed = run(small_disk / "rec.zarr", views)
    sys.stdout.write(failed.stderr)
    assert failed.returncode == 2
    assert failed.stdout == ""
    (sentence,) = failed.stderr.splitlines()
    assert "No space left on device; what is written is kept" in sentence
    kept = complete(small_disk / "rec.zarr")
    assert kept
    assert not list(small_disk.rglob("*.partial"))
    subprocess.run(["mount", "-o", "remount,size=200m", str(small_disk)], check=True)  # noqa: S607
    assert run(small_disk / "rec.zarr", views).returncode == 0
    after = complete(small_disk / "rec.zarr")
    assert {name: after[name] for name in kept} == kept
    assert content(small_disk / "rec.zarr") == content(tmp_path / "whole.zarr")
    assert json.loads((small_disk / "rec.zarr" / "zarr.json").read_text())["attributes"]["views"] == views
