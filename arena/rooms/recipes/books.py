"""Books: shelves of spines."""

import numpy as np

from arena.rooms.materials import TILE
from arena.rooms.patterns import Tint, palette, strips


def paint(rng: np.random.Generator) -> np.ndarray:
    """Colour a tile."""
    colours: list[Tint] = [
        (150, 30, 36),
        (24, 72, 112),
        (228, 214, 178),
        (36, 96, 60),
        (210, 140, 30),
        (60, 40, 74),
    ]
    shelves = []
    for _ in range(0, TILE[1], 32):
        spine = strips(rng, TILE[0], 0.02, 0.06)
        shelf = np.repeat(palette(rng, colours, TILE[0], 0.15)[spine][:, None], 32, axis=1)
        shelf[:, :2] = (70, 48, 30)
        shelf[:, 26:] *= rng.uniform(0.25, 1, TILE[0])[spine][:, None, None]
        shelves.append(shelf)
    return np.concatenate(shelves, axis=1)
