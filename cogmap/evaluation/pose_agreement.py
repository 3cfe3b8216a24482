"""Agreement of image distances with poses: how well a measure knows views from nearby poses."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.spatial.distance import cdist

from arena.angles import wrap_angle
from cogmap.errors import CogmapError
from cogmap.inputs import check_array, checked_count

Distances = Float[np.ndarray, "queries views"]

METRES_PER_RADIAN = 0.5
"""How far one would walk rather than turn by a radian."""


def motion_distances(
    queries: Float[np.ndarray, "queries 3"], poses: Float[np.ndarray, "views 3"]
) -> Distances:
    """How far apart poses are for a body: √(Δx² + Δy² + (0.5 m/rad · Δθ)²) in m, Δθ the short way round.

    Raises
    ------
    CogmapError
        For anything but poses (views, 3) of m, m, rad.
    """
    check_array("queries", queries, (None, 3))
    check_array("poses", poses, (None, 3))
    walk = cdist(queries[:, :2], poses[:, :2])
    return np.asarray(np.hypot(walk, METRES_PER_RADIAN * _turns(queries, poses)))


class Agreement(NamedTuple):
    """How well neighbours in the image are neighbours in pose."""

    recall: float
    """Share of the nearest views that are among as many nearest in pose."""
    position_median_m: float
    heading_median_deg: float
    """From a query to its nearest views."""


def pose_agreement(
    distances: Distances,
    query_poses: Float[np.ndarray, "queries 3"],
    poses: Float[np.ndarray, "views 3"],
    *,
    neighbours: int = 10,
) -> Agreement:
    """Compare the views at the smallest distances with those from the nearest poses.

    Poses are as far apart as `motion_distances` says.

    Parameters
    ----------
    distances
        Of every view from every query, by any measure.
    query_poses, poses
        Where queries and views were taken: m, m, rad.
    neighbours
        How many nearest to compare.

    Raises
    ------
    CogmapError
        For shapes that do not match, values that are not finite, fewer views than neighbours.
    """
    check_array("distances", distances, (None, None))
    check_array("query_poses", query_poses, (len(distances), 3))
    check_array("poses", poses, (distances.shape[1], 3))
    if checked_count("neighbours", neighbours) > len(poses):
        raise CogmapError(f"{len(poses)} views are too few for {neighbours} neighbours; ask for fewer")
    alike = np.argsort(distances, axis=1, kind="stable")[:, :neighbours]
    close = np.argsort(motion_distances(query_poses, poses), axis=1, kind="stable")[:, :neighbours]
    walk = cdist(query_poses[:, :2], poses[:, :2])
    turn = _turns(query_poses, poses)
    hits = (alike[:, :, None] == close[:, None, :]).any(axis=2)
    return Agreement(
        recall=float(hits.mean()),
        position_median_m=float(np.median(np.take_along_axis(walk, alike, 1))),
        heading_median_deg=float(np.rad2deg(np.median(np.take_along_axis(turn, alike, 1)))),
    )


def _turns(queries: Float[np.ndarray, "queries 3"], poses: Float[np.ndarray, "views 3"]) -> Distances:
    """Angles between headings the short way round, rad."""
    return np.asarray(np.abs(wrap_angle(queries[:, None, 2] - poses[:, 2])))
