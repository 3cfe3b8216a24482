"""Brick: courses of red bricks, stained."""

import numpy as np

from arena.rooms.patterns import bricks, stained


def paint(rng: np.random.Generator) -> np.ndarray:
    """Colour a tile."""
    courses = bricks(rng, (0.24, 0.08), [(168, 74, 52), (142, 58, 44), (190, 104, 70)], (196, 186, 170), 0.12)
    return stained(rng, courses, (70, 44, 40), 0.7)
