"""Neighbour graphs: who is next to whom in a cloud."""

import warnings
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from jaxtyping import Bool, Int
from scipy.sparse.csgraph import connected_components

from cogmap.errors import CogmapError, SeparatePiecesWarning
from cogmap.graph.knn import Metric, nearest_points
from cogmap.graph.points import AnyCloud, as_rows, checked_cloud, distinct
from cogmap.inputs import Whole

SMALLEST = float(np.finfo(np.float64).tiny)
"""Length of an edge between equal points: adds nothing to a path, yet is an edge, where a zero is none."""


class Components(NamedTuple):
    """The connected pieces of a graph, the largest first."""

    number: int
    labels: Int[np.ndarray, "points"]
    """Which piece each point belongs to, from 0."""

    @property
    def sizes(self) -> Int[np.ndarray, "pieces"]:
        """Points of each piece."""
        return np.bincount(self.labels, minlength=self.number)


def neighbour_graph(
    X: AnyCloud, neighbours: Whole = 15, *, metric: Metric = "euclidean", one_sided: int | None = None
) -> sp.csr_array:
    """Join every point to its nearest neighbours by edges as long as they are apart.

    An edge runs both ways when either end counts the other among its nearest (`nearest.nearest`: exact up to
    50,000 points). Repeated points count once: the nearest *other* points are sought among the distinct ones,
    and each repeat hangs on the first of its kind by an edge of length `SMALLEST`. Nothing else is joined: a
    cloud in pieces stays in pieces, and a point that is near to nothing stays alone.

    Parameters
    ----------
    X
        Points, one row each, dense or sparse.
    neighbours
        How many nearest points to join each point to.
    metric
        "euclidean", or "cosine" for bags of words.
    one_sided
        How many of the nearest are joined even when they do not count the point among theirs; all of them
        when None. A point of a thinly sampled place has to look far for its last neighbours, and finds them
        where it does not belong; these have nearer ones.

    Returns
    -------
    A symmetric sparse matrix (points, points) of float64 lengths > 0 in the unit of X.

    Raises
    ------
    CogmapError
        When X is not a finite matrix or has no more distinct points than `neighbours`.
    """
    (graph,) = neighbour_graphs(X, (int(neighbours),), metric=metric, one_sided=one_sided)
    return graph


def neighbour_graphs(
    X: AnyCloud, counts: Sequence[int], *, metric: Metric = "euclidean", one_sided: int | None = None
) -> list[sp.csr_array]:
    """Make the `neighbour_graph` of each of several numbers of neighbours, for which it searches but once."""
    fewest, most = min(counts), max(counts)
    if fewest < 1:
        raise CogmapError(f"neighbours is {fewest}; ask for at least one nearest neighbour")
    points, first, same = distinct(checked_cloud(X))
    if points.shape[0] <= most:
        raise CogmapError(
            f"{points.shape[0]} distinct points cannot have {most} nearest neighbours each; "
            "give more points or ask for fewer neighbours"
        )
    nearest = nearest_points(points, most, metric=metric)
    count = len(same.ravel())
    repeats = np.setdiff1d(np.arange(count), first)
    graphs = []
    for neighbours in counts:
        ends, lengths = nearest.indices[:, :neighbours], nearest.distances[:, :neighbours]
        found = ends >= 0
        if one_sided is not None:
            found &= _mutual(ends) | (np.arange(neighbours) < one_sided)
        rows = np.concatenate([np.repeat(first, found.sum(axis=1)), repeats])
        columns = np.concatenate([first[ends[found]], first[same.ravel()[repeats]]])
        # Distinct points can be nearer than rounding tells; the edge must survive that.
        values = np.concatenate([np.maximum(lengths[found], SMALLEST), np.full(len(repeats), SMALLEST)])
        graph = sp.csr_array((values.astype(np.float64), (rows, columns)), shape=(count, count))
        graphs.append(sp.csr_array(graph.maximum(graph.T)))
    return graphs


def _mutual(ends: Int[np.ndarray, "points neighbours"]) -> Bool[np.ndarray, "points neighbours"]:
    """Tell which of the points that each counts among its nearest count it among theirs."""
    points = np.arange(len(ends))[:, None]
    counted = (points * len(ends) + ends)[ends >= 0]
    return np.isin(ends * len(ends) + points, counted)


def lengthen_shortcuts(graph: sp.csr_array, shared: int = 3, *, detour: float = 5.0) -> sp.csr_array:
    """Make edges whose ends have fewer than `shared` neighbours in common `detour` times as long.

    Two steps on one sheet of a manifold share most of their surroundings; an edge that jumps from one sheet
    to another shares hardly any, makes false loops and closes true ones. No edge is lost, for such an edge
    may also be all that spans a thinly sampled place.

    Parameters
    ----------
    graph
        Symmetric lengths, as from `neighbour_graph`.
    shared
        A fifth of the neighbours of a point suits clouds from curves to solids; 0 changes nothing.
    detour
        How many times its length a shortcut counts: 5 is enough to go round it wherever there is a way round.

    References
    ----------
    Jarvis & Patrick (1973), Clustering using a similarity measure based on shared near neighbors.
    """
    joined = graph.astype(bool).astype(np.int32)
    # One more than the common neighbours, so that none at all is still an entry beside every edge.
    common = sp.csr_array((joined @ joined).multiply(joined) + joined).sorted_indices()
    longer = graph.sorted_indices()
    longer.data[common.data <= shared] *= detour
    return longer


def components(graph: sp.csr_array) -> Components:
    """Split a symmetric graph into its connected pieces."""
    count, labels = connected_components(graph, directed=False)
    order = np.argsort(-np.bincount(labels, minlength=count), kind="stable")
    return Components(int(count), np.argsort(order)[labels])


def neighbourhood_means(graph: sp.csr_array) -> sp.csr_array:
    """Make the matrix that gives each point the mean of itself and those it is joined to."""
    joined = sp.csr_array(graph.astype(bool) + sp.eye_array(graph.shape[0]))
    return sp.csr_array(sp.diags_array(1 / joined.sum(axis=1)) @ joined)


def edge_differences(
    starts: Int[np.ndarray, "edges"], ends: Int[np.ndarray, "edges"], points: int
) -> sp.csr_array:
    """Make the matrix that takes a function of points to its change along each edge."""
    edges = np.arange(len(starts))
    signs = np.repeat([-1.0, 1.0], len(starts))
    return sp.csr_array((signs, (np.tile(edges, 2), np.concatenate([starts, ends]))), (len(starts), points))


def warn_of_pieces(pieces: Components, so: str) -> None:
    """Warn of a graph in pieces, where a user would not see it otherwise; `so` says what comes of it.

    The warning is told to be of who called the function that calls this one.
    """
    if pieces.number > 1:
        largest = ", ".join(map(str, pieces.sizes[:3])) + (", …" if pieces.number > 3 else "")
        warnings.warn(
            f"the neighbour graph falls into {pieces.number} pieces (of {largest} points): {so}; "
            "ask for more neighbours, or explore between them",
            SeparatePiecesWarning,
            stacklevel=3,
        )


def checked_graph(given: AnyCloud) -> sp.csr_array:
    """Pass a symmetric graph of positive lengths through, without the zeros it may store.

    Lengths there and back that differ by rounding become their mean.

    Raises
    ------
    CogmapError
        When it is not square, not symmetric, or has a length that is not positive and finite.
    """
    graph = sp.csr_array(as_rows("the graph", given)).astype(np.float64)
    graph.eliminate_zeros()
    if graph.shape[0] != graph.shape[1]:
        raise CogmapError(f"the graph has shape {graph.shape}; expected a square, (points, points)")
    if not (np.isfinite(graph.data) & (graph.data > 0)).all():
        raise CogmapError("the graph has lengths that are not positive and finite; leave those edges out")
    skew = abs(graph - graph.T)
    if not skew.nnz:
        return graph
    if (skew - 1e-6 * graph.maximum(graph.T)).max() > 0:
        raise CogmapError(
            f"the graph is not symmetric, lengths there and back differ by up to {skew.max():g}; "
            "give each edge its length in both directions"
        )
    return sp.csr_array((graph + graph.T) / 2)
