"""Assertions for the tests of those who use this package."""

from typing import Any

import numpy as np
from jaxtyping import Num

from cogmap.shape.homology import Metric, betti


def assert_betti(
    X: Num[np.ndarray, "points *features"],
    expected: tuple[int, ...],
    metric: Metric = "geodesic",
    *,
    seed: int = 0,
    **options: Any,
) -> None:
    """Assert that a cloud has these Betti numbers, as many as are given.

    Parameters
    ----------
    X
        The points, or their distances with the metric "precomputed".
    expected
        Pieces, loops, voids; leave the last ones out to leave them open.
    metric, seed, **options
        As for `betti`.

    Raises
    ------
    AssertionError
        With the largest bars of every dimension beside their thresholds.
    """
    found = betti(X, metric, seed=seed, **{"max_dimension": len(expected) - 1, **options})
    if found.numbers[: len(expected)] != tuple(expected):
        raise AssertionError(f"expected Betti numbers {list(expected)}, found:\n{found}")
