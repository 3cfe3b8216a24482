"""White: one colour everywhere."""

import numpy as np

from arena.rooms.materials import TILE


def paint(_: np.random.Generator) -> np.ndarray:
    """Colour a tile."""
    return np.broadcast_to(np.array((226, 226, 222)), (*TILE, 3))
