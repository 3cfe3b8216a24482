"""The memory of a growing map: what its stages see, kept while it grows, so that it is made only once."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from jaxtyping import Int

from cogmap.growing.expedition import Share


class Memory:
    """Columns of arrays, a row for each view, filled share by share.

    Of a million views these are 24 MB of poses, 12 MB of smells, 240 MB of codes and, instead of them, 80 MB
    of what charts recall.
    """

    def __init__(self, shares: Sequence[Share]) -> None:
        self._shares = shares
        self._columns: dict[str, tuple[np.ndarray, ...]] = {}
        self._there: dict[str, set[int]] = {}

    def lacks(self, name: str) -> list[int]:
        """Tell of which shares something is not known."""
        there = self._there.get(name, set())
        return [number for number in range(len(self._shares)) if number not in there]

    def put(self, name: str, number: int, found: Sequence[np.ndarray]) -> None:
        """Keep what was found for a share."""
        views = self._shares[-1].rows.stop
        if name not in self._columns:
            self._columns[name] = tuple(np.empty((views, *part.shape[1:]), part.dtype) for part in found)
        for column, part in zip(self._columns[name], found, strict=True):
            column[self._shares[number].rows] = part
        self._there.setdefault(name, set()).add(number)

    def take(self, name: str, rows: slice | Int[np.ndarray, "_"]) -> tuple[np.ndarray, ...]:
        """Give some rows of all columns."""
        return tuple(column[rows] for column in self._columns[name])

    def forget(self, name: str) -> None:
        """Keep something no longer."""
        self._columns.pop(name, None)
        self._there.pop(name, None)


def picked(views: int, first: int, count: int, seed: tuple[int, int]) -> Int[np.ndarray, "_"]:
    """Pick views in an order of chance, each once before any comes again: `count` from the `first` on."""
    rows = list[np.ndarray]()
    end = first + count
    while first < end:
        again, at = divmod(first, views)
        rows.append(_shuffled(views, (*seed, again))[at : at + end - first])
        first += len(rows[-1])
    return np.concatenate(rows)


@lru_cache(maxsize=2)
def _shuffled(views: int, seed: tuple[int, ...]) -> Int[np.ndarray, "views"]:
    return np.random.default_rng(seed).permutation(views)
