"""Sweeps by commands of their own: killed, on a Dask cluster, on a disk that is full."""

import json
import os
import resource
import signal
import time
from collections import Counter
from pathlib import Path

import numpy as np
import psutil
import pytest

from tests import clusters
from tests.forked import Forked, prepare

ROOT = Path(__file__).parents[3]
NEEDED = (
    "tests.cogmap.sweeps.laboratory", "cogmap.commands.results", *clusters.NEEDED,
)  # fmt: skip
THREADS = {"OMP_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1"}
SWEEP = """
experiment = "cheap"
seeds = [0, 1, 2]
[grid]
"nose.noise" = [0.0, 0.1, 0.2, 0.4]
"map.charts" = [10, 11, 12, 13, 14]
"""
POINTS = 60


class Laboratory:
    """A folder with a sweep's file, and the diary of what was begun there."""

    def __init__(self, folder: Path, text: str = SWEEP, seconds: float = 0.1) -> None:
        self.file, self.diary, self.out = folder / "sweep.toml", folder / "diary", folder / "out"
        self.file.write_text(text, encoding="utf-8")
        self.diary.touch()
        self.environment = {
            **os.environ, "DIARY": str(self.diary), "SECONDS": str(seconds), "PYTHONPATH": str(ROOT),
            **THREADS,
        }  # fmt: skip

    def start(self, *words: object, longest_file: int = resource.RLIM_INFINITY) -> Forked:
        command = ["sweep", self.file, "--out", self.out, "--json", *words]
        return Forked("cogmap.cli:main", command, self.environment, self.file.with_name("said"), longest_file)

    def run(self, *words: object, longest_file: int = resource.RLIM_INFINITY) -> tuple[int, str, str]:
        process = self.start(*words, longest_file=longest_file)
        out, err = process.communicate(timeout=500)
        return process.poll(), out, err

    def finished(self) -> set[str]:
        """What the diary calls the points that are put down."""
        found = set()
        # not those that are being written, whose names begin with a dot
        for file in (self.out / "points").glob("[!.]*.json"):
            point = json.loads(file.read_text(encoding="utf-8"))["point"]
            found.add(f"{point['nose']['noise']} {point['map']['charts']} {point['seed']}")
        return found

    def begun(self) -> Counter[str]:
        return Counter(self.diary.read_text(encoding="utf-8").splitlines())

    def tables(self) -> tuple[bytes, bytes]:
        return (self.out / "table.csv").read_bytes(), (self.out / "table.parquet").read_bytes()


def laboratory(folder: Path, text: str = SWEEP, seconds: float = 0.1) -> Laboratory:
    folder.mkdir()
    return Laboratory(folder, text, seconds)


@pytest.fixture(scope="module", autouse=True)
def _prepared() -> None:
    prepare(NEEDED, PYTHONPATH=str(ROOT), **THREADS)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> Laboratory:
    lab = Laboratory(tmp_path_factory.mktemp("undisturbed"), seconds=0.0)
    status, out, err = lab.run("--workers", 1)
    assert status == 0, err
    assert json.loads(out) == {"table": str(lab.out / "table.csv"), "rows": 60, "failed": 12, "untrusted": 16}
    assert set(lab.begun().values()) == {1}
    return lab


@pytest.mark.parametrize(
    ("kills", "workers"), [(2, 1), pytest.param(10, 2, marks=pytest.mark.full)], ids=["twice", "ten times"]
)
def test_killed_at_any_moment_the_same_command_goes_on(
    kills: int, workers: int, undisturbed: Laboratory, tmp_path: Path
) -> None:
    lab = laboratory(tmp_path / "killed")
    rng = np.random.default_rng(kills)
    finished: dict[str, int] = {}
    for kill in range(kills):
        before = len(lab.finished())
        process = lab.start("--workers", workers)
        while len(lab.finished()) == before and process.poll() is None:
            time.sleep(0.02)
        time.sleep(rng.uniform(0, 0.6))
        assert process.poll() is None, process.communicate()
        if kill % 2:
            process.kill()  # its workers go on with the points they are at
        else:
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        known, begun = lab.finished(), lab.begun()
        finished |= {name: begun[name] for name in known if name not in finished}
    assert len(finished) >= kills
    status, _, err = lab.run("--workers", workers)
    assert status == 0, err
    assert lab.tables() == undisturbed.tables()
    begun = lab.begun()
    assert {name: begun[name] for name in finished} == finished
    assert len(begun) == POINTS
    assert sum(begun.values()) <= POINTS + kills * workers
    assert not (lab.out / "walks").exists()


def test_two_dask_workers_give_the_same_table(undisturbed: Laboratory, tmp_path: Path) -> None:
    lab = laboratory(tmp_path / "cluster")
    with clusters.cluster(lab.file.parent, lab.environment, workers=2) as (address, _):
        status, out, err = lab.run("--scheduler", address)
    assert status == 0, err
    assert json.loads(out)["rows"] == POINTS
    assert lab.tables() == undisturbed.tables()
    assert set(lab.begun().values()) == {1}


def test_a_scheduler_that_dies_is_one_sentence_and_the_rest_is_done_here(tmp_path: Path) -> None:
    text = 'experiment = "cheap"\n[grid]\n"nose.noise" = [0, 1]\n"map.charts" = [1, 2, 3, 4, 5, 6]\n'
    lab = laboratory(tmp_path / "dying", text, seconds=1.0)
    with clusters.cluster(lab.file.parent, lab.environment, workers=1) as (address, processes):
        process = lab.start("--scheduler", address)
        while not lab.finished() and process.poll() is None:
            time.sleep(0.05)
        processes[0].kill()
        _, err = process.communicate(timeout=120)
    assert process.poll() == 2, err
    assert err.startswith(f"cogmap: the Dask scheduler at {address} was lost; all points that are finished")
    assert len(err.splitlines()) == 1
    kept = lab.finished()
    assert 0 < len(kept) < 12
    lab.environment["SECONDS"] = "0"
    assert lab.run("--workers", 1)[0] == 0
    assert all(lab.begun()[name] == 1 for name in kept)


def test_a_disk_that_takes_no_more_is_one_sentence(tmp_path: Path) -> None:
    text = 'experiment = "cheap"\nseeds = [0]\n[grid]\n"nose.noise" = [0]\n"map.charts" = [1, 2]\n'
    lab = laboratory(tmp_path / "full", text, seconds=0.0)
    status, out, err = lab.run("--workers", 1, longest_file=1000)
    assert status == 2
    assert not out
    assert "all points that are finished are kept" in err
    assert len(err.splitlines()) == 1
    assert lab.run("--workers", 1)[0] == 0


def test_a_worker_that_is_killed_is_one_sentence(tmp_path: Path) -> None:
    text = 'experiment = "cheap"\n[grid]\n"nose.noise" = [0]\n"map.charts" = [1, 2, 3, 4]\n'
    lab = laboratory(tmp_path / "killed", text, seconds=3.0)
    process = lab.start("--workers", 2)
    while not lab.begun() and process.poll() is None:
        time.sleep(0.05)
    workers = [
        child.pid for child in psutil.Process(process.pid).children() if "loky" in str(child.cmdline())
    ]
    os.kill(workers[-1], signal.SIGKILL)
    _, err = process.communicate(timeout=60)
    assert process.poll() == 2
    assert "was killed, perhaps for lack of memory" in err


def works(process: psutil.Process) -> bool:
    try:
        return bool(process.status() != psutil.STATUS_ZOMBIE)
    except psutil.NoSuchProcess:
        return False


@pytest.mark.full
def test_processes_of_a_sweep_that_is_killed_end_within_a_minute_or_two(tmp_path: Path) -> None:
    text = 'experiment = "cheap"\n[grid]\n"nose.noise" = [0]\n"map.charts" = [1, 2, 3, 4]\n'
    lab = laboratory(tmp_path / "orphans", text, seconds=1.0)
    process = lab.start("--workers", 2)
    while not lab.begun() and process.poll() is None:
        time.sleep(0.05)
    orphans = psutil.Process(process.pid).children(recursive=True)
    assert len(orphans) >= 2
    process.kill()
    process.wait()
    until = time.monotonic() + 120
    while any(map(works, orphans)) and time.monotonic() < until:
        time.sleep(0.5)
    assert not any(map(works, orphans))
