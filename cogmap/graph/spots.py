"""Spots: points that lie so close that they count once, as what is seen while turning on the spot does."""

import math
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int

from cogmap.graph.knn import nearest_points
from cogmap.graph.neighbour_graph import SMALLEST, neighbour_graph

CLOSE = 0.15
"""Distance within which points are one spot, over the usual one to the tenth nearest."""
LOOKED_THROUGH = 60
"""Nearest points among which others of the same spot are sought."""


class Spots(NamedTuple):
    """Points that stand for those close to them."""

    first: Int[np.ndarray, "spots"]
    """Which point each spot is, rising."""
    of: Int[np.ndarray, "points"]
    """Which of these is nearest to each point."""


def spots(X: Float[np.ndarray, "points features"]) -> Spots:
    """Choose points in their order, each unless one that is chosen is close to it.

    Parameters
    ----------
    X
        Points, one row each, more than one.
    """
    first, reach = np.arange(len(X)), math.nan
    while True:
        near, apart = nearest_points(X[first], min(LOOKED_THROUGH, len(first) - 1))
        if math.isnan(reach):
            reach = CLOSE * float(np.median(apart[:, min(10, near.shape[1]) - 1]))
        chosen = np.zeros(len(first), bool)
        for point, (others, close) in enumerate(zip(near, apart <= reach, strict=True)):
            chosen[point] = not chosen[others[close]].any()
        # Where more lie close than are looked through, some are chosen beside each other at first.
        if chosen.all():
            break
        first = first[chosen]
    return Spots(first, nearest_points(X[first], 1, queries=X).indices[:, 0])


def spot_graph(X: Float[np.ndarray, "points features"], neighbours: int) -> sp.csr_array:
    """Join every spot to the nearest others, and the points of a spot to the one that stands for them.

    A point is joined to others than those of its spot by way of this one, so that where many were taken they
    are not each other's only neighbours.

    Parameters
    ----------
    X
        Points, one row each.
    neighbours
        How many other spots each is joined to; fewer where there are no more.

    Returns
    -------
    A symmetric sparse matrix (points, points) of lengths > 0 in the unit of X.

    Raises
    ------
    CogmapError
        For a single spot, which has no neighbours.
    """
    first, nearest = spots(X)
    between = sp.coo_array(neighbour_graph(X[first], min(neighbours, max(len(first) - 1, 1))))
    others = np.setdiff1d(np.arange(len(X)), first)
    there = first[nearest[others]]
    hung = np.maximum(np.linalg.norm(X[others] - X[there], axis=1), SMALLEST)
    rows = np.concatenate([first[between.row], others, there])
    columns = np.concatenate([first[between.col], there, others])
    lengths = np.concatenate([between.data, hung, hung])
    return sp.csr_array((lengths, (rows, columns)), shape=(len(X), len(X)))
