"""Points of a sweep done by processes: those of this machine, or of a cluster."""

import json
import logging
import threading
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from pathlib import Path
from typing import Any

from joblib import Parallel, delayed
from joblib.externals.loky.process_executor import TerminatedWorkerError

from cogmap.errors import CogmapError, UntrustedMapWarning
from cogmap.experiments.registry import Experiment, experiments, run_experiment
from cogmap.portable import arithmetic
from cogmap.sweeps.ledger import KEPT, MARK, Ledger, Record, disk_errors, is_full_disk
from cogmap.sweeps.points import Point
from cogmap.sweeps.table import comparable

PATIENCE = 10.0
"""Seconds that a scheduler has to answer, and to find a worker."""
KILLED = f"killed, perhaps for lack of memory; {KEPT}"
"""What has happened to those who did a point."""
_alone = threading.Lock()
"""One point at a time in a process: they set the number of threads for all of it."""


def do(point: Point, *, ledger: Ledger, chosen: Experiment, again: bool) -> None:
    """Do the experiment of a point and put down what comes of it, unless this has been done.

    Parameters
    ----------
    point
        What to do.
    ledger
        Where what it finds is put down.
    chosen
        The experiment; a worker's own catalogue may not have it.
    again
        Whether to do it once more if it has failed.

    Raises
    ------
    CogmapError
        When this cannot be put down; whatever the experiment raises is put down.
    """
    if not (ledger.folder / MARK).exists():
        raise CogmapError(
            f"a worker finds no sweep in {ledger.folder}; choose a folder that all workers share"
        )
    with disk_errors(ledger.folder), _alone, ledger.lock(point):
        if ledger.lacks(point, again=again):
            experiments().setdefault(point.experiment, chosen)
            ledger.write(point, _outcome(point, ledger.walks) | {"arithmetic": arithmetic()})


def _outcome(point: Point, walks: Path) -> Record:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UntrustedMapWarning)  # the table says which maps are not trusted
            found = run_experiment(
                point.experiment,
                room=point.room if point.any_room else None,
                views=point.views,
                seed=point.seed,
                library=walks,
                **point.overrides,
            )
        return {"metrics": json.loads(json.dumps(comparable(found.metrics)))}
    except Exception as error:  # noqa: BLE001  whatever a point raises is its outcome
        if is_full_disk(error):
            raise CogmapError(f"there is no space left on a disk; {KEPT}") from None
        return {"error": " ".join(f"{type(error).__name__}: {error}".split())}


def on_this_machine(
    work: Callable[[Point], None], points: Sequence[Point], workers: int | None
) -> Iterator[None]:
    """Do points in processes, as many as there are cores unless told; yields as each is done.

    Raises
    ------
    CogmapError
        When what a point found cannot be put down, or a process was killed.
    """
    # Processes without work end after some seconds, as all do whose sweep was killed.
    pool = Parallel(workers or -1, batch_size=1, return_as="generator_unordered", idle_worker_timeout=10.0)
    try:
        yield from pool(delayed(work)(point) for point in points)
    except TerminatedWorkerError:
        raise CogmapError(f"a process that did a point was {KILLED}") from None


def on_cluster(work: Callable[[Point], None], points: Sequence[Point], address: str) -> Iterator[None]:
    """Do points on the workers of a Dask scheduler; yields as each is done.

    Raises
    ------
    CogmapError
        When the scheduler does not answer, has no workers or is lost, and as `on_this_machine`.
    """
    with _client(address) as client:
        from distributed import KilledWorker, as_completed  # noqa: PLC0415  part of an extra

        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            raise CogmapError(
                f"the Dask scheduler at {address} has no workers; start one with `dask worker {address}`"
            ) from None
        futures = client.map(work, points, pure=False)
        done = as_completed(futures, loop=client.loop)
        lost = f"the Dask scheduler at {address} was lost; {KEPT}"
        try:
            for _ in points:
                while not done.has_ready():
                    if client.status != "running":
                        raise CogmapError(lost)
                    time.sleep(0.05)
                yield next(done).result()
        except KilledWorker:
            raise CogmapError(f"workers that did a point were {KILLED}") from None
        except (OSError, CancelledError):
            raise CogmapError(lost) from None
        finally:
            if client.status == "running":
                client.cancel(futures)


def _client(address: str) -> Any:
    """Reach a Dask scheduler; the client is to be closed."""
    try:
        from distributed import Client  # noqa: PLC0415  part of an extra
    except ImportError:
        raise CogmapError("a scheduler needs Dask; `pip install 'cogmap[cluster]'`") from None
    for part in ("distributed", "distributed.client"):
        logging.getLogger(part).setLevel(logging.CRITICAL)  # what goes wrong is said in one sentence
    try:
        return Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError):
        raise CogmapError(
            f"no Dask scheduler answers at {address} within {PATIENCE:g} s; start one with `dask scheduler` "
            "and give the address it prints"
        ) from None
