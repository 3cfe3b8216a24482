"""Leather: brown, worn unevenly."""

import numpy as np

from arena.rooms.patterns import cloud


def paint(rng: np.random.Generator) -> np.ndarray:
    """Colour a tile."""
    shade = 1 + 0.25 * cloud(rng, 0.15, 0.15) + 0.1 * cloud(rng, 0.012, 0.012)
    return np.array((112.0, 52, 36)) * shade[..., None]
