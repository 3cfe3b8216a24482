"""Plaid: coloured threads crossing."""

import numpy as np

from arena.rooms.materials import TILE
from arena.rooms.patterns import Tint, palette, strips


def paint(rng: np.random.Generator) -> np.ndarray:
    """Colour a tile."""
    colours: list[Tint] = [(178, 34, 46), (24, 54, 92), (220, 196, 120), (30, 92, 66)]
    warp = palette(rng, colours, TILE[0], 0.1)[strips(rng, TILE[0], 0.03, 0.14)]
    weft = palette(rng, colours, TILE[1], 0.1)[strips(rng, TILE[1], 0.03, 0.14)]
    colour: np.ndarray = 0.6 * warp[:, None] + 0.4 * weft[None]
    return colour
