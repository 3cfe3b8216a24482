"""Vietoris-Rips persistence on landmarks of a metric space."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
import scipy.sparse as sp
from gudhi.sklearn import RipsPersistence
from jaxtyping import Float, Int
from scipy.spatial.distance import cdist

from cogmap.graph.neighbour_graph import lengthen_shortcuts, neighbour_graphs
from cogmap.graph.shortest_paths import Paths

Bars = Float[np.ndarray, "_ 2"]
"""Births and deaths, in the unit of the distances; each dimension has its own number of bars."""


@runtime_checkable
class Space(Protocol):
    """A cloud with a metric."""

    def __len__(self) -> int:
        """Count the points."""

    def nearer(self, point: int, nearest: Float[np.ndarray, "points"]) -> Float[np.ndarray, "points"]:
        """Take the smaller of distances from points of this space, and those from another."""

    def among(self, points: Int[np.ndarray, "some"]) -> Float[np.ndarray, "some some"]:
        """Measure between some points, symmetric up to rounding; infinite between pieces."""


@dataclass(frozen=True)
class Straight:
    """Points and the straight lines between them."""

    points: Float[np.ndarray, "points features"]

    def __len__(self) -> int:
        return len(self.points)

    def nearer(self, point: int, nearest: Float[np.ndarray, "points"]) -> Float[np.ndarray, "points"]:
        """See `Space`."""
        return np.asarray(np.minimum(nearest, cdist(self.points[point : point + 1], self.points)[0]))

    def among(self, points: Int[np.ndarray, "some"]) -> Float[np.ndarray, "some some"]:
        """See `Space`."""
        return np.asarray(cdist(self.points[points], self.points[points]))


@dataclass(frozen=True)
class Given:
    """Distances that are known already."""

    distances: Float[np.ndarray, "points points"]

    def __len__(self) -> int:
        return len(self.distances)

    def nearer(self, point: int, nearest: Float[np.ndarray, "points"]) -> Float[np.ndarray, "points"]:
        """See `Space`."""
        return np.asarray(np.minimum(nearest, self.distances[point]))

    def among(self, points: Int[np.ndarray, "some"]) -> Float[np.ndarray, "some some"]:
        """See `Space`."""
        return np.asarray(self.distances[np.ix_(points, points)])


def euclidean(X: Float[np.ndarray, "points features"]) -> Space:
    """Straight lines."""
    return Straight(X.astype(np.float64))


def geodesic(X: Float[np.ndarray, "points features"], neighbours: int) -> Paths:
    """Shortest paths in the neighbour graph, shunning its shortcuts; infinite between its pieces."""
    (space,) = geodesics(X, (neighbours,))
    return space


def geodesics(
    X: Float[np.ndarray, "points features"], counts: Sequence[int], one_sided: int | None = None
) -> list[Paths]:
    """Shortest paths in the graphs of several numbers of neighbours, as `geodesic` (`neighbour_graph`)."""
    graphs = neighbour_graphs(X, counts, one_sided=one_sided)
    return [along(*found) for found in zip(graphs, counts, strict=True)]


def along(graph: sp.csr_array, neighbours: int) -> Paths:
    """Shortest paths in a graph that joins each point to so many neighbours, shunning its shortcuts."""
    return Paths(lengthen_shortcuts(graph, neighbours // 5))


class Landmarks(NamedTuple):
    """Points spread evenly over a cloud, the farthest first."""

    indices: Int[np.ndarray, "landmarks"]
    held: Int[np.ndarray, "landmarks"]
    """How many points of the cloud have this landmark as their nearest."""


def farthest_points(space: Space, count: int, start: int) -> Landmarks:
    """Take, from `start` on, always the point farthest from all taken so far.

    Stops short of `count` when every point coincides with a landmark. The first m landmarks are those that
    a call with `count` = m returns.

    References
    ----------
    Gonzalez (1985), Clustering to minimize the maximum intercluster distance.
    """
    index = [start]
    nearest = space.nearer(start, np.full(len(space), np.inf))
    holder = np.zeros(len(nearest), dtype=np.int64)
    while len(index) < count:
        farthest = int(nearest.argmax())
        if nearest[farthest] <= 0:
            break
        before, nearest = nearest, space.nearer(farthest, nearest)
        holder[nearest < before] = len(index)
        index.append(farthest)
    return Landmarks(np.array(index), np.bincount(holder, minlength=len(index)))


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
