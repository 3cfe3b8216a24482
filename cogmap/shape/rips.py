"""Vietoris-Rips persistence on landmarks of a metric space."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from gudhi.sklearn import RipsPersistence
from jaxtyping import Float, Int
from scipy.sparse.csgraph import dijkstra
from scipy.spatial.distance import cdist

from cogmap.graph.neighbour_graph import lengthen_shortcuts, neighbour_graph

Bars = Float[np.ndarray, "_ 2"]
"""Births and deaths, in the unit of the distances; each dimension has its own number of bars."""
DistancesFrom = Callable[[int], Float[np.ndarray, "points"]]
"""A metric, given as the distances from one point to all of them."""


class Landmarks(NamedTuple):
    """Points spread evenly over a cloud, the farthest first."""

    indices: Int[np.ndarray, "landmarks"]
    distances: Float[np.ndarray, "landmarks landmarks"]
    held: Int[np.ndarray, "landmarks"]
    """How many points of the cloud have this landmark as their nearest."""


def euclidean(X: Float[np.ndarray, "points features"]) -> DistancesFrom:
    """Straight lines."""
    X = X.astype(np.float64)
    return lambda point: np.asarray(cdist(X[point : point + 1], X)[0])


def geodesic(X: Float[np.ndarray, "points features"], neighbours: int) -> DistancesFrom:
    """Shortest paths in the neighbour graph, shunning its shortcuts; infinite between its pieces."""
    return along(neighbour_graph(X, neighbours), neighbours)


def along(graph: sp.csr_array, neighbours: int) -> DistancesFrom:
    """Shortest paths in a graph that joins each point to so many neighbours, shunning its shortcuts."""
    graph = lengthen_shortcuts(graph, neighbours // 5)
    return lambda point: np.asarray(dijkstra(graph, indices=[point])[0])


def farthest_points(distances_from: DistancesFrom, count: int, start: int) -> Landmarks:
    """Take, from `start` on, always the point farthest from all taken so far.

    Stops short of `count` when every point coincides with a landmark. The first m landmarks are those that
    a call with `count` = m returns.

    References
    ----------
    Gonzalez (1985), Clustering to minimize the maximum intercluster distance.
    """
    rows = [distances_from(start)]
    index = [start]
    nearest = rows[0].copy()
    holder = np.zeros(len(nearest), dtype=np.int64)
    while len(index) < count:
        farthest = int(nearest.argmax())
        if nearest[farthest] <= 0:
            break
        rows.append(distances_from(farthest))
        holder[rows[-1] < nearest] = len(index)
        np.minimum(nearest, rows[-1], out=nearest)
        index.append(farthest)
    taken = np.array(index)
    held = np.bincount(holder, minlength=len(taken))
    return Landmarks(taken, np.stack([row[taken] for row in rows]), held)


def rips_bars(distances: Float[np.ndarray, "points points"], dimensions: Sequence[int]) -> tuple[Bars, ...]:
    """Compute persistent homology of the Vietoris-Rips filtration, one array of bars per dimension asked for.

    Coefficients are modulo 11, so that torsion stays out of it. Within a connected piece the filtration runs
    to the full radius, so only pieces (dimension 0) live for ever. Only the lower triangle is read: distances
    that are asymmetric by rounding would make gudhi hang.

    Parameters
    ----------
    distances
        Symmetric up to rounding; infinite between pieces.
    dimensions
        Which homology groups.

    Returns
    -------
    Per dimension the bars (birth, death), those with the largest `ratios` first.
    """
    finite = distances[np.isfinite(distances)]
    rips = RipsPersistence(
        list(dimensions), threshold=float(finite.max(initial=0)), input_type="lower distance matrix"
    )
    bars = [
        np.asarray(found, dtype=np.float64).reshape(-1, 2) for found in rips.fit_transform([distances])[0]
    ]
    return tuple(found[np.argsort(-ratios(found), kind="stable")] for found in bars)


def ratios(bars: Bars) -> Float[np.ndarray, "_"]:
    """How much a bar stands out, free of scale: π = death / birth.

    Pieces are all born at zero, so theirs is the death over the median finite death of all pieces.

    References
    ----------
    Bobrowski & Skraba (2023), A universal null-distribution for topological data analysis.
    """
    birth, death = bars.T
    if not birth.any():
        finite = death[np.isfinite(death)]
        birth = np.median(finite) if len(finite) else 1.0
    return np.asarray(death / birth)
