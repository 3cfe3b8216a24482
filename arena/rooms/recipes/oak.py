"""Oak: level boards with grain."""

import numpy as np

from arena.rooms.materials import TILE
from arena.rooms.patterns import cloud, palette, strips


def paint(rng: np.random.Generator) -> np.ndarray:
    """Colour a tile."""
    board = strips(rng, TILE[1], 0.12, 0.2)
    grain = 1 + 0.14 * cloud(rng, 0.3, 0.008) + 0.1 * cloud(rng, 0.2, 0.15)
    boards = palette(rng, [(176, 128, 72), (150, 104, 58)], TILE[1], 0.12)[board]
    colour: np.ndarray = boards * grain[..., None]
    return colour
