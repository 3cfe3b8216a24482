"""Granite: grey stone with cool veins."""

import numpy as np

from arena.rooms.patterns import stone


def paint(rng: np.random.Generator) -> np.ndarray:
    """Colour a tile."""
    return stone(rng, (120, 118, 126), (1.0, -0.2, 0.8))
