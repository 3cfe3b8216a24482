"""Top k: the best of many candidates, kept while they stream by."""

import typing

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
@typing.no_type_check
def offer_to_rows(scores: np.ndarray, best: np.ndarray, names: np.ndarray, first: int) -> None:
    """Offer column b of `scores` (rows, columns), by the name of `first` + b, to the ranking of each row.

    A ranking is a row of `best`, scores in falling order, and of `names`. A candidate enters when it is
    better than the last, and then stands behind its equals.
    """
    for row in range(scores.shape[0]):
        for column in range(scores.shape[1]):
            if scores[row, column] > best[row, -1]:
                _enter(best[row], names[row], scores[row, column], first + column)


@njit(cache=True, nogil=True)
@typing.no_type_check
def offer_to_columns(scores: np.ndarray, best: np.ndarray, names: np.ndarray, first: int) -> None:
    """Offer row a of `scores` (rows, columns), by the name of `first` + a, to the ranking of each column."""
    for row in range(scores.shape[0]):
        for column in range(scores.shape[1]):
            if scores[row, column] > best[column, -1]:
                _enter(best[column], names[column], scores[row, column], first + row)


@njit(cache=True, nogil=True)
@typing.no_type_check
def _enter(best: np.ndarray, names: np.ndarray, score: float, name: int) -> None:
    rank = len(best) - 1
    while rank > 0 and best[rank - 1] < score:
        best[rank] = best[rank - 1]
        names[rank] = names[rank - 1]
        rank -= 1
    best[rank] = score
    names[rank] = name
