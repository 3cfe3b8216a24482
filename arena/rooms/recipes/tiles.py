"""Tiles: glazed squares in blues and white."""

import numpy as np

from arena.rooms.patterns import Tint, bricks, stained


def paint(rng: np.random.Generator) -> np.ndarray:
    """Colour a tile."""
    colours: list[Tint] = [(64, 128, 150), (214, 220, 206), (40, 84, 112), (120, 176, 164)]
    tiles = bricks(rng, (0.16, 0.16), colours, (230, 230, 224), 0.08)
    return stained(rng, tiles, (30, 74, 96), 0.6, 0.4)
