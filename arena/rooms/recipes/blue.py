"""Blue: one colour everywhere."""

import numpy as np

from arena.rooms.materials import TILE


def paint(_: np.random.Generator) -> np.ndarray:
    """Colour a tile."""
    return np.broadcast_to(np.array((40, 70, 180)), (*TILE, 3))
