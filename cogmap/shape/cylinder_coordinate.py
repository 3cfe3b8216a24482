"""The height coordinate of a cylinder, which its loop leaves over."""

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float
from scipy.sparse.linalg import cg

from cogmap.errors import CogmapError
from cogmap.graph.neighbour_graph import checked_graph
from cogmap.graph.points import AnyCloud
from cogmap.inputs import AnyArray, as_array, as_floats
from cogmap.threads import one_thread


def height_coordinate(
    graph: AnyCloud,
    embedding: AnyArray,
    phase: AnyArray,
    *,
    similar: float = 1 / 40,
    end: float = 0.08,
) -> Float[np.ndarray, "points"]:
    r"""Measure how far each point of a cylinder is from its two ends: 0 at one, 1 at the other.

    What the harmonics of the phase do not explain of an embedding varies mostly along the cylinder. Ranked
    along it among the points of nearly the same phase, the first and last few are the ends. Between them the
    height is the function that changes least over the edges of the graph,

    .. math:: \min_h \sum_{ij} (h_j - h_i)^2.

    Only the ends come from the embedding: bent or sheared as that may be, heights are even between them.

    Parameters
    ----------
    graph
        Symmetric lengths, as from `neighbour_graph`.
    embedding
        Coordinates, as from `LandmarkIsomap`.
    phase
        rad, as from `circular_coordinate`; points where it is NaN get no height.
    similar
        Share of the points that are compared with each other because their phases are close.
    end
        Share of these that is taken for either end of the cylinder.

    Raises
    ------
    CogmapError
        When the arrays do not match, or too few points have a phase: fewer than 1 / `similar`.
    """
    graph = checked_graph(graph)
    embedding, phase = as_floats(as_array("embedding", embedding)), as_floats(as_array("phase", phase))
    if not graph.shape[0] == len(embedding) == len(phase):
        raise CogmapError(
            f"the graph has {graph.shape[0]} points, the embedding {len(embedding)} and there are "
            f"{len(phase)} phases; give one row a point"
        )
    points = np.flatnonzero(np.isfinite(phase))
    if len(points) < 1 / similar:
        raise CogmapError(
            f"{len(points)} points have a phase; a cylinder takes at least {round(1 / similar)}"
        )
    with one_thread():
        along = _left_over(embedding[points], phase[points])
        rank = _rank_in_slices(along, phase[points], similar)
        height = _between(graph[points][:, points], rank <= end, rank >= 1 - end)
    everywhere = np.full(len(phase), np.nan)
    everywhere[points] = height
    return everywhere


def _left_over(
    embedding: Float[np.ndarray, "points components"], phase: Float[np.ndarray, "points"]
) -> Float[np.ndarray, "points"]:
    """Project what the phase does not explain of an embedding on its principal axis."""
    # The loop's own shape is made of the first three harmonics of the phase.
    turns = np.arange(1, 4) * phase[:, None]
    waves = np.column_stack([np.ones(len(phase)), np.cos(turns), np.sin(turns)])
    rest = embedding - waves @ np.linalg.lstsq(waves, embedding, rcond=None)[0]
    return np.asarray(rest @ np.linalg.svd(rest.T @ rest)[0][:, 0])


def _rank_in_slices(
    values: Float[np.ndarray, "points"], phase: Float[np.ndarray, "points"], similar: float
) -> Float[np.ndarray, "points"]:
    """Give the share of points with nearly the same phase that have a smaller value."""
    order = np.argsort(phase, kind="stable")
    half = max(10, round(similar * len(values) / 2))
    ring = values[order[(np.arange(len(values))[:, None] + np.arange(-half, half + 1)) % len(values)]]
    rank = np.empty(len(values))
    rank[order] = (ring < ring[:, half : half + 1]).mean(axis=1)
    return rank


def _between(graph: sp.csr_array, low: np.ndarray, high: np.ndarray) -> Float[np.ndarray, "points"]:
    """Solve Laplace's equation on a graph with the value 0 at `low` and 1 at `high`."""
    joined = graph.astype(bool).astype(np.float64)
    laplacian = sp.csr_array(sp.diags_array(joined.sum(axis=1)) - joined)
    height = np.where(high, 1.0, np.where(low, 0.0, 0.5))
    free = ~(low | high)
    fixed = laplacian[free][:, high].sum(axis=1)
    height[free] = cg(laplacian[free][:, free], -fixed, x0=height[free], rtol=1e-8)[0]
    return height
