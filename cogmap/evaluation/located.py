"""Where panoramas are that were placed among remembered ones of known poses."""

import numpy as np
from jaxtyping import Float

from arena.angles import wrap_angle
from cogmap.navigation.panorama_localiser import TurnedLocation


def turned_poses(
    location: TurnedLocation, poses: Float[np.ndarray, "views 3"]
) -> Float[np.ndarray, "queries 3"]:
    """Give x, y (m) and heading (rad) of each query, from those of the remembered views."""
    near = poses[location.indices]
    places = np.einsum("qk,qkc->qc", location.weights, near[:, :, :2])
    ahead = (location.turn_weights * np.exp(1j * (near[:, :, 2] + location.turns))).sum(axis=1)
    return np.column_stack([places, wrap_angle(np.angle(ahead))])
