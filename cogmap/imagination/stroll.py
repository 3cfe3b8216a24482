"""A stroll along a route: evenly spaced poses that turn before they go."""

import numpy as np
from jaxtyping import Float

from arena.angles import wrap_angle


def stroll(
    route: Float[np.ndarray, "points 2"],
    *,
    step: float,
    turn: float,
    start: float | None = None,
    end: float | None = None,
) -> Float[np.ndarray, "poses 3"]:
    """Give poses (x, y, heading) of a body that follows a route, facing the way it goes.

    Parameters
    ----------
    route
        Corners of the way, the first and the last included.
    step, turn
        How far the body goes from pose to pose, and how far it turns (rad), at most.
    start, end
        Headings to begin and to end with; those of the way when None.
    """
    legs = np.diff(route, axis=0)
    lengths = np.linalg.norm(legs, axis=1)
    legs, lengths, corners = legs[lengths > 0], lengths[lengths > 0], route[:-1][lengths > 0]
    ways = np.arctan2(legs[:, 1], legs[:, 0])
    first = start if start is not None else ways[0] if len(ways) else 0.0
    poses = [(*route[0], first)]
    for corner, leg, length, way in zip(corners, legs, lengths, ways, strict=True):
        poses += _turned(corner, poses[-1][2], way, turn)
        shares = np.linspace(0, 1, int(np.ceil(length / step - 1e-9)) + 1)[1:]
        poses += [(*(corner + share * leg), way) for share in shares]
    if end is not None:
        poses += _turned(route[-1], poses[-1][2], end, turn)
    stroll = np.array(poses, dtype=np.float64)
    stroll[:, 2] = wrap_angle(stroll[:, 2])
    return stroll


def _turned(
    place: Float[np.ndarray, "2"], heading: float, wanted: float, turn: float
) -> list[tuple[float, float, float]]:
    """Turn on the spot, the short way."""
    angle = float(wrap_angle(np.array(wanted - heading)))
    count = int(np.ceil(abs(angle) / turn - 1e-9))
    return [(*place, heading + angle * share) for share in np.linspace(0, 1, count + 1)[1:]]
