"""Maps grown by commands of their own: killed, by two threads, on Dask workers that are killed."""

import json
import os
import signal
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests import clusters
from tests.cogmap.growing.conftest import SMALL, weights
from tests.forked import Forked, prepare

ROOT = Path(__file__).parents[3]
THREADS = {"OMP_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1"}
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT), **THREADS}


@pytest.fixture(scope="module", autouse=True)
def _prepared() -> None:
    prepare(("cogmap.commands.growing", *clusters.NEEDED), PYTHONPATH=str(ROOT), **THREADS)


def start(folder: Path, *words: object) -> Forked:
    small = ("explorers", "views", "charts", "epoch")
    options = [word for name in small for word in (f"--{name}", SMALL[name])]
    sizes = [f"map.{name}={SMALL[name]}" for name in ("components", "place_cells", "heading_cells")]
    command = [
        "grow",
        "furnished",
        "--out",
        folder / "map",
        *options,
        "--width",
        90,
        "--height",
        15,
        "--json",
    ]
    command += [word for size in sizes for word in ("--set", size)]
    return Forked("cogmap.cli:main", [*command, *words], ENVIRONMENT, folder / "said")


def wait_for(there: Callable[[], Any], process: Forked) -> None:
    until = time.monotonic() + 500
    while not there():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < until
        time.sleep(0.002)


def lent(folder: Path) -> list[Path]:
    return list((folder / "map.growing").glob("lent-*"))


def test_two_threads_give_the_same_bytes_though_the_command_is_killed(
    undisturbed: Path, tmp_path: Path
) -> None:
    process = start(tmp_path, "--threads", 2)
    wait_for((tmp_path / "map.growing" / "now").exists, process)
    wait_for(lambda: lent(tmp_path), process)
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    assert process.poll() == -signal.SIGKILL
    process = start(tmp_path, "--threads", 2)
    out, err = process.communicate(timeout=500)
    assert process.poll() == 0, err
    assert json.loads(out)["map"] == str(tmp_path / "map")
    assert weights(tmp_path / "map") == weights(undisturbed)
    assert not (tmp_path / "map.growing").exists()


def test_dask_workers_give_the_same_bytes_though_one_is_killed(undisturbed: Path, tmp_path: Path) -> None:
    with clusters.cluster(tmp_path, ENVIRONMENT, workers=2) as (address, processes):
        process = start(tmp_path, "--scheduler", address)
        wait_for((tmp_path / "map.growing" / "now").exists, process)
        wait_for(lambda: lent(tmp_path), process)
        processes[1].kill()
        _, err = process.communicate(timeout=500)
        assert processes[1].poll() == -signal.SIGKILL
    assert process.poll() == 0, err
    assert weights(tmp_path / "map") == weights(undisturbed)
