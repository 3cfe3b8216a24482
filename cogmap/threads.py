"""Same arrays whatever the number of threads."""

from collections.abc import Iterator
from contextlib import contextmanager

import cv2
import torch
from threadpoolctl import threadpool_limits


@contextmanager
def one_thread() -> Iterator[None]:
    """Run torch, BLAS and OpenCV on one thread: sums are then always taken in the same order."""
    threads, others = torch.get_num_threads(), cv2.getNumThreads()
    torch.set_num_threads(1)
    cv2.setNumThreads(1)
    try:
        with threadpool_limits(limits=1), torch.no_grad():
            yield
    finally:
        torch.set_num_threads(threads)
        cv2.setNumThreads(others)
