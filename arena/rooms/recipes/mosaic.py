"""Mosaic: small bright squares, stained."""

import numpy as np

from arena.rooms.patterns import Tint, bricks, stained


def paint(rng: np.random.Generator) -> np.ndarray:
    """Colour a tile."""
    colours: list[Tint] = [(230, 180, 60), (40, 90, 140), (170, 50, 60), (232, 226, 210), (60, 130, 100)]
    return stained(rng, bricks(rng, (0.12, 0.12), colours, (50, 50, 54), 0.1), (240, 210, 120), 0.6)
