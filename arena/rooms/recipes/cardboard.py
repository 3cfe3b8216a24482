"""Cardboard: plain brown with strips of tape."""

import numpy as np

from arena.rooms.materials import TILE
from arena.rooms.patterns import cloud, strips


def paint(rng: np.random.Generator) -> np.ndarray:
    """Colour a tile."""
    shade = 1 + 0.08 * cloud(rng, 0.2, 0.2) + 0.04 * cloud(rng, 0.01, 0.3)
    colour = np.array((188.0, 150, 102)) * shade[..., None]
    tape = np.isin(strips(rng, TILE[0], 0.08, 0.3) % 4, 0)[:, None, None]
    return np.where(tape, 0.5 * colour + 90, colour)
