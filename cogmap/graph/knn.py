"""Nearest neighbours (k-NN): which points are nearest, exactly, or by descent where that would be slow."""

from typing import Literal, NamedTuple, get_args

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int
from joblib import Parallel, cpu_count, delayed
from sklearn.neighbors import NearestNeighbors
from sklearn.preprocessing import normalize
from threadpoolctl import get_cached_controller

from cogmap.errors import CogmapError
from cogmap.graph.points import AnyCloud, Checked, checked_cloud
from cogmap.graph.top_k import offer
from cogmap.inputs import Whole, check_choice, checked_count

Metric = Literal["euclidean", "cosine"]
"""What distance is between points.

"euclidean"
    the length of their difference;
"cosine"
    the chord √(2 − 2 cos) between their directions. Unlike the cosine distance 1 − cos, which is half its
    square, it obeys the triangle inequality. The origin has no direction and is near to nothing.
"""

BLOCK = 2048
"""Points compared at a time: 16 MB for every thread."""


class Nearest(NamedTuple):
    """Points of a cloud that are near to each of some points, the nearest first."""

    indices: Int[np.ndarray, "points neighbours"]
    """Which points of the cloud; −1 where there are no more."""
    distances: Float[np.ndarray, "points neighbours"]
    """How far they are; infinite where there are no more."""


def nearest_points(
    cloud: AnyCloud,
    neighbours: Whole,
    *,
    queries: AnyCloud | None = None,
    metric: Metric = "euclidean",
    exact: int = 50_000,
) -> Nearest:
    """Find the nearest points of a cloud for each query, or for each of its own points among the others.

    In the cosine metric only directions less than a right angle apart are near, so that views without a word
    in common never are. The same bits come out whatever the number of threads.

    Parameters
    ----------
    cloud
        Where to look.
    neighbours
        How many to find.
    queries
        Whose neighbours to find.
    metric
        "euclidean" or "cosine".
    exact
        Points of the largest cloud that is searched exactly; larger ones are searched by descent
        (pynndescent), which is several times faster and misses some neighbours in a thousand.

    Raises
    ------
    CogmapError
        For points that are not finite, features that do not match, too few points, an unknown metric.

    References
    ----------
    Dong, Charikar & Li (2011), Efficient k-nearest neighbor graph construction for generic similarity
    measures.
    """
    return PointSearch(cloud, metric=metric, exact=exact)(neighbours, queries)


class PointSearch:
    """Nearest neighbours in a cloud that is searched many times: it is checked and prepared once.

    But for descent, whose index is made for a number of neighbours, at every search.

    Parameters
    ----------
    cloud, metric, exact
        As for `nearest_points`.
    """

    def __init__(self, cloud: AnyCloud, *, metric: Metric = "euclidean", exact: int = 50_000) -> None:
        check_choice("metric", metric, get_args(Metric))
        cloud = checked_cloud(cloud)
        self._cloud, self._metric, self._exact = (
            normalize(cloud) if metric == "cosine" else cloud,
            metric,
            exact,
        )
        if metric == "euclidean" and self._cloud.shape[0] <= exact:
            self._index = NearestNeighbors().fit(self._cloud)

    def __call__(self, neighbours: Whole, queries: AnyCloud | None = None) -> Nearest:
        """Find so many neighbours of each query, or of each point of the cloud among the others."""
        cloud, others = self._cloud, None if queries is None else checked_cloud(queries)
        neighbours = checked_count("neighbours", neighbours)
        if others is not None and others.shape[1] != cloud.shape[1]:
            raise CogmapError(
                f"the queries have {others.shape[1]} features but the cloud has {cloud.shape[1]}; "
                "give as many"
            )
        if cloud.shape[0] - (others is None) < neighbours:
            raise CogmapError(
                f"{cloud.shape[0]} points are too few for {neighbours} neighbours; "
                "give more points or ask for fewer neighbours"
            )
        if self._metric == "cosine":
            return _by_direction(cloud, others, neighbours, self._exact)
        if cloud.shape[0] > self._exact:
            return _by_descent(cloud, others, neighbours)
        distances, indices = self._index.kneighbors(others, neighbours)
        return Nearest(indices, distances)


def _by_direction(cloud: Checked, queries: Checked | None, neighbours: int, exact: int) -> Nearest:
    """Search a cloud of unit vectors."""
    # Chord below which directions have a positive cosine beyond rounding.
    right_angle = np.sqrt(2) * (1 - 1e-6)
    queries = None if queries is None else normalize(queries)
    if cloud.shape[0] <= exact:
        return _by_products(cloud, queries, neighbours)
    test = cloud if queries is None else queries
    pointing, asking = (np.flatnonzero(abs(part).sum(axis=1)) for part in (cloud, test))
    found = _by_descent(cloud[pointing], None if queries is None else queries[asking], neighbours)
    indices = np.full((test.shape[0], neighbours), -1)
    distances = np.full(indices.shape, np.inf)
    indices[asking] = np.where(found.distances < right_angle, pointing[found.indices], -1)
    distances[asking] = np.where(found.distances < right_angle, found.distances, np.inf)
    return Nearest(indices, distances)


def _by_products(cloud: Checked, queries: Checked | None, neighbours: int) -> Nearest:
    """Rank the cosines of all pairs, block by block, each block on one thread for the sake of its bits."""
    columns = _blocks(cloud)
    rows = columns if queries is None else _blocks(queries)
    # Column blocks come in rising order for every row block, so that equals are ranked by index.
    pairs = [(a, b) for a in range(len(rows)) for b in range(a if queries is None else 0, len(columns))]
    best = np.zeros((sum(map(len, rows)), neighbours), np.result_type(rows[0], columns[0]))
    names = np.full(best.shape, -1)
    with get_cached_controller().limit(limits=1):
        # For one product no threads need be started.
        crew = Parallel(cpu_count() if len(pairs) > 1 else 1, backend="threading", return_as="generator")
        products = crew(delayed(np.matmul)(rows[a], columns[b].T) for a, b in pairs)
        for (a, b), cosines in zip(pairs, products, strict=True):
            here, there = (slice(block * BLOCK, (block + 1) * BLOCK) for block in (a, b))
            if queries is None and a == b:
                np.fill_diagonal(cosines, 0)
            offer(cosines, best[here], names[here], there.start, axis=1)
            if queries is None and a < b:
                offer(cosines, best[there], names[there], here.start, axis=0)
    chords = np.sqrt(np.maximum(2 - 2 * best.astype(np.float64), 0))
    return Nearest(names, np.where(names < 0, np.inf, chords))


def _blocks(cloud: Checked) -> list[Float[np.ndarray, "_ features"]]:
    parts = (cloud[first : first + BLOCK] for first in range(0, cloud.shape[0], BLOCK))
    return [part.toarray() if sp.issparse(part) else part for part in parts]


def _by_descent(cloud: Checked, queries: Checked | None, neighbours: int) -> Nearest:
    try:
        from pynndescent import NNDescent  # noqa: PLC0415
    except ImportError:
        raise CogmapError(
            f"the neighbours of {cloud.shape[0]} points are found by descent, which needs pynndescent; it is "
            "not installed: run `pip install 'cogmap[large]'`, or give `exact` as many points and wait"
        ) from None
    index = NNDescent(_as_matrix(cloud), n_neighbors=max(30, neighbours + 1), random_state=0)
    if queries is not None:
        return Nearest(*index.query(_as_matrix(queries), k=neighbours))
    indices, distances = index.neighbor_graph
    itself = indices == np.arange(len(indices))[:, None]
    # A stable sort by "is itself" moves each point behind its neighbours and leaves their order.
    order = np.argsort(itself, axis=1, kind="stable")[:, :neighbours]
    return Nearest(np.take_along_axis(indices, order, 1), np.take_along_axis(distances, order, 1))


def _as_matrix(cloud: Checked) -> np.ndarray | sp.csr_matrix:
    # pynndescent knows no sparse arrays yet.
    return sp.csr_matrix(cloud) if sp.issparse(cloud) else cloud
