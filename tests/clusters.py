"""A Dask cluster of processes, some of which may be killed."""

import json
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.forked import Forked

NEEDED = ("distributed.cli.dask_scheduler", "distributed.cli.dask_worker")
"""What a process that such are forked from is to have imported."""


@contextmanager
def cluster(folder: Path, environment: dict[str, str], workers: int) -> Iterator[tuple[str, list[Forked]]]:
    """Give the address of a scheduler, and its processes: it is the first, and workers follow."""
    file = folder / "scheduler.json"
    options = ["--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", file]
    processes = [Forked("distributed.cli.dask_scheduler:main", options, environment, folder / "scheduler")]
    try:
        while not (file.exists() and file.stat().st_size) and processes[0].poll() is None:
            time.sleep(0.1)
        address = json.loads(file.read_text(encoding="utf-8"))["address"]
        words = [address, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", folder]
        processes += [
            Forked("distributed.cli.dask_worker:main", words, environment, folder / f"worker{number}")
            for number in range(workers)
        ]
        yield address, processes
    finally:
        for process in processes:
            process.kill()
            process.communicate()
