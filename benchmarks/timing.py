"""How speed is measured: beside a peer, turn by turn, so that what else the machine does hits both."""

import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numba
import numpy as np

from arena import Arena

ROUNDS = 15
ROOM = Arena.load("furnished")

Figures = dict[str, "float | int | str | list[float] | Figures"]


def rate(work: Callable[[], int]) -> float:
    """Units per second of some work that tells how many units it has done."""
    started = time.perf_counter()
    done = work()
    return done / (time.perf_counter() - started)


def seconds(work: Callable[[], object], repeats: int = 3) -> float:
    """Shortest of a few runs, after one to warm up."""
    work()
    return min(1 / rate(lambda: (work(), 1)[1]) for _ in range(repeats))


def versus(ours: Callable[[], int], peer: Callable[[], int], rounds: int = ROUNDS, *, beside: str) -> Figures:
    """Fastest rates of both, turn by turn, their ratio, and the ratio's median and spread over the turns.

    `beside` is the name of the peer. Ratios are of speeds: above 1 we are faster.
    """
    ours()
    peer()
    rates = np.array([(rate(ours), rate(peer)) for _ in range(rounds)])
    low, middle, high = np.percentile(rates[:, 0] / rates[:, 1], [0, 50, 100])
    mine, its = rates.max(axis=0)
    return {
        "peer": beside,
        "per_s": float(mine),
        "peer_per_s": float(its),
        "ratio": float(mine / its),
        "ratio_median": float(middle),
        "ratio_lowest": float(low),
        "ratio_highest": float(high),
    }


@contextmanager
def one_core() -> Iterator[None]:
    """Keep this process, and those that it starts, on one core and numba on one thread."""
    cores, threads = os.sched_getaffinity(0), numba.get_num_threads()
    os.sched_setaffinity(0, {max(cores)})
    numba.set_num_threads(1)
    try:
        yield
    finally:
        os.sched_setaffinity(0, cores)
        numba.set_num_threads(threads)


def poses(count: int, room: Arena = ROOM) -> np.ndarray:
    """Draw poses in a room."""
    rng = np.random.default_rng(0)
    return np.column_stack([room.sample_free(count, 0.18, rng), rng.uniform(-np.pi, np.pi, count)])


def missing(peer: str) -> Figures:
    """Say how to get a peer that is not installed."""
    return {"peer": peer, "not_measured": f"{peer} is not installed; `pip install 'cogmap[peers]'`"}
