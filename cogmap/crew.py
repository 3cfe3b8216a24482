"""Crews: processes that share work, those of this machine or of a cluster."""

import logging
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from itertools import islice
from typing import Any, Generic, NamedTuple, TypeVar

from joblib import Parallel, delayed
from joblib.externals.loky.process_executor import TerminatedWorkerError

from cogmap.errors import CogmapError

Item = TypeVar("Item")
Done = TypeVar("Done")

PATIENCE = 10.0
"""Seconds that a scheduler has to answer, and to find a worker."""
AHEAD = 3
"""Items that a worker of a cluster has or waits for: no more lie with the scheduler."""
RECOUNT = 1.0
"""Seconds after which workers are counted again: they come and go."""


class Wording(NamedTuple):
    """How work is spoken of."""

    item: str
    """What a process does at a time, as "a point"."""
    kept: str
    """What becomes of what is done when the work ends early."""


def on_this_machine(
    work: Callable[[Item], Done], items: Iterable[Item], workers: int | None, wording: Wording
) -> Iterator[Done]:
    """Do items in processes, as many as there are cores unless told; yields what comes of each as it is done.

    Raises
    ------
    CogmapError
        When a process was killed, and what the work raises.
    """
    # Processes without work end after half a minute, as all do whose master was killed; sooner, joblib
    # complains on a machine that is busy. Arrays are handed over as they are: those that it maps from files
    # cannot be written, of which torch complains.
    pool = Parallel(
        workers or -1,
        batch_size=1,
        return_as="generator_unordered",
        idle_worker_timeout=30.0,
        max_nbytes=None,
    )
    try:
        yield from pool(delayed(work)(item) for item in items)
    except TerminatedWorkerError:
        raise CogmapError(
            f"a process that did {wording.item} was killed, perhaps for lack of memory; {wording.kept}"
        ) from None


def on_cluster(
    work: Callable[[Item], Done], items: Iterable[Item], address: str, wording: Wording
) -> Iterator[Done]:
    """Do items on the workers of a Dask scheduler; yields what comes of each as it is done.

    Workers may come and go: what one was at that is gone is done by another.

    Raises
    ------
    CogmapError
        When the scheduler does not answer, has no workers or is lost, when three workers in a row were killed
        over one item, and what the work raises.
    """
    with _client(address) as client:
        from distributed import KilledWorker  # noqa: PLC0415  part of an extra

        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            raise CogmapError(
                f"the Dask scheduler at {address} has no workers; start one with `dask worker {address}`"
            ) from None
        lost = CogmapError(f"the Dask scheduler at {address} was lost; {wording.kept}")
        given = _Given(client, work, iter(items))
        try:
            while (future := given.take(lost)) is not None:
                yield future.result()
        except KilledWorker:
            raise CogmapError(
                f"workers that did {wording.item} were killed, perhaps for lack of memory; {wording.kept}"
            ) from None
        except (OSError, CancelledError):
            raise lost from None
        finally:
            if client.status == "running":
                client.cancel(list(given.futures))


class _Given(Generic[Item, Done]):
    """What a cluster has been given and is not done with: as much as keeps all busy, and no more."""

    def __init__(self, client: Any, work: Callable[[Item], Done], left: Iterator[Item]) -> None:
        from distributed import as_completed  # noqa: PLC0415  part of an extra

        self.futures = set[Any]()
        self._client, self._work, self._left = client, work, left
        self._done = as_completed([], loop=client.loop)
        self._room, self._counted = 0, -RECOUNT

    def take(self, lost: Exception) -> Any:
        """Wait for the next future that is done, and give what is left to who is free; None at the end."""
        self._give()
        if not self.futures:
            return None
        while not self._done.has_ready():
            if self._client.status != "running":
                raise lost
            time.sleep(0.05)
            self._give()
        future = next(self._done)
        self.futures.discard(future)
        return future

    def _give(self) -> None:
        now = time.monotonic()
        if now - self._counted >= RECOUNT:
            self._room, self._counted = AHEAD * max(1, len(self._client.nthreads())), now
        for item in islice(self._left, max(0, self._room - len(self.futures))):
            future = self._client.submit(self._work, item, pure=False)
            self.futures.add(future)
            self._done.add(future)


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
