"""Who is next to whom in a cloud of vectors."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int, Num
from scipy.sparse.csgraph import connected_components
from sklearn.neighbors import NearestNeighbors

from cogmap.errors import CogmapError

TINY = float(np.finfo(np.float64).tiny)
"""Length of an edge between equal points: adds nothing to a path, yet is an edge, where a zero is none."""

DETOUR = 5.0
"""How many times its length a shortcut counts: enough to go round it wherever there is a way round."""


class Components(NamedTuple):
    """The connected pieces of a graph."""

    number: int
    labels: Int[np.ndarray, "points"]
    """Which piece each point belongs to, from 0."""


def neighbour_graph(X: Num[np.ndarray, "points *features"], neighbours: int = 15) -> sp.csr_array:
    """Join every point to its nearest neighbours, exactly, by edges as long as they are apart.

    An edge runs both ways when either end counts the other among its nearest. Repeated points count once:
    the nearest *other* points are sought among the distinct ones, and each repeat hangs on the first of its
    kind by an edge of length `TINY`. Nothing else is joined: a cloud in pieces stays in pieces.

    Parameters
    ----------
    X
        Vectors, compared by Euclidean distance.
    neighbours
        How many nearest points to join each point to.

    Returns
    -------
    A symmetric sparse matrix (points, points) of float64 lengths > 0 in the unit of X.

    Raises
    ------
    CogmapError
        When X is not a finite matrix or has no more distinct points than `neighbours`.
    """
    X = checked_cloud(X)
    if neighbours < 1:
        raise CogmapError(f"neighbours is {neighbours}; ask for at least one nearest neighbour")
    distinct, first, same = np.unique(X, axis=0, return_index=True, return_inverse=True)
    if len(distinct) <= neighbours:
        raise CogmapError(
            f"{len(distinct)} distinct points cannot have {neighbours} nearest neighbours each; "
            "give more points or ask for fewer neighbours"
        )
    lengths, ends = NearestNeighbors(n_neighbors=neighbours).fit(distinct).kneighbors()
    repeats = np.setdiff1d(np.arange(len(X)), first)
    rows = np.concatenate([np.repeat(first, neighbours), repeats])
    columns = np.concatenate([first[ends.ravel()], first[same.ravel()[repeats]]])
    # Distinct points can be nearer than rounding tells; the edge must survive that.
    values = np.concatenate([np.maximum(lengths.ravel(), TINY), np.full(len(repeats), TINY)])
    graph = sp.csr_array((values.astype(np.float64), (rows, columns)), shape=(len(X), len(X)))
    return sp.csr_array(graph.maximum(graph.T))


def lengthen_shortcuts(graph: sp.csr_array, shared: int = 3) -> sp.csr_array:
    """Make edges whose ends have fewer than `shared` neighbours in common `DETOUR` times as long.

    Two steps on one sheet of a manifold share most of their surroundings; an edge that jumps from one sheet
    to another shares hardly any, makes false loops and closes true ones. No edge is lost, for such an edge
    may also be all that spans a thinly sampled place.

    Parameters
    ----------
    graph
        Symmetric lengths, as from `neighbour_graph`.
    shared
        A fifth of the neighbours of a point suits clouds from curves to solids; 0 changes nothing.

    References
    ----------
    Jarvis & Patrick (1973), Clustering using a similarity measure based on shared near neighbors.
    """
    joined = graph.astype(bool).astype(np.int32)
    # One more than the common neighbours, so that none at all is still an entry beside every edge.
    common = sp.csr_array((joined @ joined).multiply(joined) + joined).sorted_indices()
    longer = graph.sorted_indices()
    longer.data[common.data <= shared] *= DETOUR
    return longer


def components(graph: sp.csr_array) -> Components:
    """Split a symmetric graph into its connected pieces."""
    count, labels = connected_components(graph, directed=False)
    return Components(int(count), labels)


def checked_cloud(X: Num[np.ndarray, "points *features"]) -> Float[np.ndarray, "points features"]:
    """Pass a finite matrix through as floats.

    Raises
    ------
    CogmapError
        When X has not two axes, no features, or a value that is not finite.
    """
    if X.ndim != 2 or X.shape[1] == 0:
        raise CogmapError(f"the cloud has shape {X.shape}; expected one row per point, (points, features)")
    if not np.isfinite(X).all():
        raise CogmapError("the cloud holds NaN or infinite values; remove those points first")
    return X if np.issubdtype(X.dtype, np.floating) else X.astype(np.float64)
