"""Deviation of a path from the straight one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from arena.angles import wrap_angle
from cogmap.evaluation.pose_agreement import METRES_PER_RADIAN
from cogmap.inputs import check_array


class Deviation(NamedTuple):
    """Distances of a path to the straight segment between its ends: m, m², m."""

    mean: float
    variance: float
    maximum: float


def path_deviation(path: Float[np.ndarray, "steps 3"], *, samples: int = 200) -> Deviation:
    """Measure how far a path strays from the straight segment between its ends, in (x, y, ½ m/rad · heading).

    The path turns the short way between poses, the segment the short way from start to goal; a heading
    differs from that of the nearest point of the segment by the short way round.

    Parameters
    ----------
    path
        Poses (x, y, heading) in m and rad, start first.
    samples
        Places at equal distance along the path that speak for it.

    Raises
    ------
    CogmapError
        For poses that are not finite triples.
    """
    check_array("path", path, (None, 3))
    turns = np.unwrap(path[:, 2]) * METRES_PER_RADIAN
    points = np.column_stack([path[:, :2], turns])
    gone = np.insert(np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)), 0, 0.0)
    sampled = np.column_stack([np.interp(np.linspace(0, gone[-1], samples), gone, part) for part in points.T])
    straight = points[-1] - points[0]
    straight[2] = METRES_PER_RADIAN * wrap_angle(straight[2] / METRES_PER_RADIAN)
    length = straight @ straight
    share = np.clip((sampled - points[0]) @ straight / length, 0, 1) if length else np.zeros(samples)
    away = sampled - points[0] - share[:, None] * straight
    away[:, 2] = METRES_PER_RADIAN * wrap_angle(away[:, 2] / METRES_PER_RADIAN)
    distance = np.linalg.norm(away, axis=1)
    return Deviation(float(distance.mean()), float(distance.var()), float(distance.max()))


def path_length(path: Float[np.ndarray, "steps 3"]) -> float:
    """Give the length of a path in the plane, m."""
    return float(np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1).sum())
