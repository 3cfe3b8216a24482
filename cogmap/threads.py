"""Same arrays whatever the number of threads, on every device."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from itertools import chain, islice
from threading import local
from typing import TypeVar

import cv2
import torch
from joblib import cpu_count
from threadpoolctl import get_cached_controller

Item = TypeVar("Item")
Done = TypeVar("Done")

CPU = torch.device("cpu")
_HERE = local()
"""Whether this thread runs on one already: to say so again takes a third of a millisecond."""


@contextmanager
def one_thread(device: torch.device = CPU) -> Iterator[None]:
    """Run torch, BLAS and OpenCV on one thread: sums are then always taken in the same order.

    On another device than the processor, let torch use no algorithm in which chance orders them.
    """
    if device == CPU and getattr(_HERE, "alone", False):
        with torch.no_grad():
            yield
        return
    threads, others = torch.get_num_threads(), cv2.getNumThreads()
    ordered = device == CPU or torch.are_deterministic_algorithms_enabled()
    torch.set_num_threads(1)
    cv2.setNumThreads(1)
    if not ordered:
        torch.use_deterministic_algorithms(mode=True)
    within, _HERE.alone = getattr(_HERE, "alone", False), True
    try:
        with get_cached_controller().limit(limits=1), torch.no_grad():
            yield
    finally:
        _HERE.alone = within
        torch.set_num_threads(threads)
        cv2.setNumThreads(others)
        if not ordered:
            torch.use_deterministic_algorithms(mode=False)


def in_order(
    work: Callable[[Item], Done], items: Iterable[Item], workers: int | None = None
) -> Iterator[Done]:
    """Work on items in as many threads as there are cores; give what comes of them in their order.

    Each item is one thread's alone, so that the number of threads changes no bit. No more than one item a
    thread waits to be taken: memory does not grow with their number. One alone is done here: a thread takes
    as long to start as a view takes to be perceived; and so are those of a thread that is one of many.
    `workers` is how many threads, as many as cores when None.
    """
    items = iter(items)
    begun = list(islice(items, 2))
    alone = len(begun) < 2 or getattr(_HERE, "one_of_many", False)
    # cores are counted where it matters: that takes as long as some layers take for a view
    workers = 1 if alone else workers or cpu_count()
    if workers == 1:
        yield from map(work, chain(begun, items))
        return
    with ThreadPoolExecutor(workers, initializer=_begin) as pool:
        waiting: deque[Future[Done]] = deque()
        for item in chain(begun, items):
            waiting.append(pool.submit(work, item))
            if len(waiting) > workers:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()


def _begin() -> None:
    torch.set_num_threads(1)  # which torch counts for each thread anew
    _HERE.one_of_many = True
