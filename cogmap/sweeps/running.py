"""Points of a sweep done by processes: those of this machine, or of a cluster."""

from __future__ import annotations

import json
import logging
import threading
import time
import warnings
from collections.abc import Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager
from typing import Any, NamedTuple

from joblib import Parallel, delayed
from joblib.externals.loky.process_executor import TerminatedWorkerError

from cogmap.errors import CogmapError, UntrustedMapWarning
from cogmap.experiments.registry import Experiment, experiments, run_experiment
from cogmap.portable import arithmetic
from cogmap.sweeps.ledger import KEPT, MARK, Ledger, disk_errors, is_full_disk
from cogmap.sweeps.points import Point
from cogmap.sweeps.table import comparable

PATIENCE = 10.0
"""Seconds that a scheduler has to answer, and to find a worker."""
PULSE = 0.05
"""Seconds between two looks for what a cluster has done."""
IDLE = 10.0
"""Seconds after which a process without work ends, as all do whose sweep was killed."""
_alone = threading.Lock()
"""One point at a time in a process: they set the number of threads for all of it."""


class Task(NamedTuple):
    """A point to be done, and where what it finds is put down."""

    ledger: Ledger
    point: Point
    chosen: Experiment
    """What to do; a worker's own catalogue may not have it."""
    again: bool
    """Whether to do it once more if it has failed."""


def do(task: Task) -> None:
    """Do the experiment of a point and put down what comes of it, unless this has been done.

    Raises
    ------
    CogmapError
        When this cannot be put down; whatever the experiment raises is put down.
    """
    ledger, point = task.ledger, task.point
    if not (ledger.folder / MARK).exists():
        raise CogmapError(
            f"a worker finds no sweep in {ledger.folder}; choose a folder that all workers share"
        )
    with disk_errors(ledger.folder), _alone, ledger.lock(point):
        known = ledger.read(point)
        if known is None or (task.again and "error" in known):
            ledger.write(point, _outcome(task) | {"arithmetic": arithmetic()})


def _outcome(task: Task) -> dict[str, Any]:
    point = task.point
    experiments().setdefault(point.experiment, task.chosen)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UntrustedMapWarning)  # the table says which maps are not trusted
            found = run_experiment(
                point.experiment,
                room=point.room if point.any_room else None,
                views=point.views,
                seed=point.seed,
                library=task.ledger.walks,
                **point.overrides,
            )
        metrics: dict[str, Any] = json.loads(json.dumps(comparable(found.metrics)))
    except Exception as error:  # noqa: BLE001  whatever a point raises is its outcome
        if is_full_disk(error):
            raise CogmapError(f"there is no space left on a disk; {KEPT}") from None
        return {"error": " ".join(f"{type(error).__name__}: {error}".split())}
    return {"metrics": metrics}


def on_this_machine(tasks: Sequence[Task], workers: int | None) -> Iterator[None]:
    """Do tasks in processes, as many as there are cores unless told; yields as each is done.

    Raises
    ------
    CogmapError
        When what a task found cannot be put down, or a process was killed.
    """
    pool = Parallel(workers or -1, batch_size=1, return_as="generator_unordered", idle_worker_timeout=IDLE)
    try:
        yield from pool(delayed(do)(task) for task in tasks)
    except TerminatedWorkerError:
        raise CogmapError(
            f"a process that did a point was killed, perhaps for lack of memory; {KEPT}"
        ) from None


def on_cluster(tasks: Sequence[Task], address: str) -> Iterator[None]:
    """Do tasks on the workers of a Dask scheduler; yields as each is done.

    Raises
    ------
    CogmapError
        When the scheduler does not answer, has no workers or is lost, and as `on_this_machine`.
    """
    with _client(address) as client:
        from distributed import as_completed  # noqa: PLC0415  part of an extra
        from distributed.scheduler import KilledWorker  # noqa: PLC0415

        futures = client.map(do, tasks, pure=False)
        done = as_completed(futures, loop=client.loop)
        lost = f"the Dask scheduler at {address} was lost; {KEPT}"
        try:
            for _ in tasks:
                while not done.has_ready():
                    if client.status != "running":
                        raise CogmapError(lost)
                    time.sleep(PULSE)
                yield next(done).result()
        except KilledWorker:
            raise CogmapError(
                f"workers that did a point were killed, perhaps for lack of memory; {KEPT}"
            ) from None
        except (OSError, CancelledError):
            raise CogmapError(lost) from None
        finally:
            if client.status == "running":
                client.cancel(futures)


@contextmanager
def _client(address: str) -> Iterator[Any]:
    try:
        from distributed import Client  # noqa: PLC0415  part of an extra
    except ImportError:
        raise CogmapError("a scheduler needs Dask; `pip install 'cogmap[cluster]'`") from None
    for part in ("distributed", "distributed.client"):
        logging.getLogger(part).setLevel(logging.CRITICAL)  # what goes wrong is said in one sentence
    try:
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError):
        raise CogmapError(
            f"no Dask scheduler answers at {address} within {PATIENCE:g} s; start one with `dask scheduler` "
            "and give the address it prints"
        ) from None
    with client:
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            raise CogmapError(
                f"the Dask scheduler at {address} has no workers; start one with `dask worker {address}`"
            ) from None
        yield client
