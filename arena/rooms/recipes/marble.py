"""Marble: warm stone with veins."""

import numpy as np

from arena.rooms.patterns import stone


def paint(rng: np.random.Generator) -> np.ndarray:
    """Colour a tile."""
    return stone(rng, (168, 150, 120), (-0.4, 0.2, 1.0))
