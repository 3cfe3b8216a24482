"""Timber: upright planks with grain and dark seams."""

import numpy as np

from arena.rooms.materials import TILE
from arena.rooms.patterns import cloud, palette, stained, strips


def paint(rng: np.random.Generator) -> np.ndarray:
    """Colour a tile."""
    plank = strips(rng, TILE[0], 0.12, 0.35)
    colour = palette(rng, [(196, 152, 92), (150, 104, 58), (224, 190, 130), (112, 78, 50)], TILE[0], 0.1)[
        plank
    ]
    grain = 1 + 0.1 * cloud(rng, 0.01, 0.2)
    seam = np.r_[True, np.diff(plank) > 0][:, None, None]
    return stained(rng, np.where(seam, 40.0, colour[:, None] * grain[..., None]), (88, 60, 40), 0.4)
