"""Relaxation: phases and heights of a cloud made to agree with those around each point, and read between."""

import numpy as np
from jaxtyping import Float, Int

from arena.angles import wrap_angle
from cogmap.graph.affine_weights import affine_weights
from cogmap.graph.knn import nearest_points

NEIGHBOURS, TIMES = 30, 2
"""Of a point whose coordinates are relaxed, and how often they are."""
READ = 15
"""Neighbours between which the coordinates of another point are read."""
RIDGE = 1e-3
"""Of the affine weights."""


def relaxed(
    codes: Float[np.ndarray, "points features"],
    phases: Float[np.ndarray, "points loops"],
    heights: Float[np.ndarray, "points heights"],
) -> tuple[Float[np.ndarray, "points loops"], Float[np.ndarray, "points heights"]]:
    """Give each point what the affine weights of its neighbours say of its phases (rad) and heights, twice.

    What varies smoothly over the cloud is kept, and the noise of single edges of the neighbour graph, from
    which both were found, averages out.
    """
    near = nearest_points(codes, NEIGHBOURS).indices
    weights = affine_weights(codes, near, codes, RIDGE)
    for _ in range(TIMES):
        phases, heights = _interpolated(near, weights, phases, heights)
    return phases, heights


def read_between(
    codes: Float[np.ndarray, "points features"],
    phases: Float[np.ndarray, "points loops"],
    heights: Float[np.ndarray, "points heights"],
    queries: Float[np.ndarray, "queries features"],
) -> tuple[Float[np.ndarray, "queries loops"], Float[np.ndarray, "queries heights"]]:
    """Read phases (rad) and heights of other points between their nearest ones of a cloud."""
    near = nearest_points(codes, READ, queries=queries).indices
    return _interpolated(near, affine_weights(codes, near, queries, RIDGE), phases, heights)


def _interpolated(
    near: Int[np.ndarray, "queries neighbours"],
    weights: Float[np.ndarray, "queries neighbours"],
    phases: Float[np.ndarray, "points loops"],
    heights: Float[np.ndarray, "points heights"],
) -> tuple[Float[np.ndarray, "queries loops"], Float[np.ndarray, "queries heights"]]:
    here = phases[near[:, 0]]
    turns = wrap_angle(phases[near] - here[:, None])
    turned = wrap_angle(here + np.einsum("qk,qkl->ql", weights, turns))
    return turned, np.einsum("qk,qkh->qh", weights, heights[near])
