"""The background of an empty world: the plain floor up to the horizon, and the ceiling above."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import UInt8

from arena.eye.projection import Lens, direction
from arena.eye.texture_sampling import BLOCK

_Colour = tuple[float, float, float] | tuple[int, int, int]


class Backdrop(NamedTuple):
    """An empty world, twice."""

    columns: UInt8[np.ndarray, "columns blocks"]
    """Red, green, blue and a spare byte a row, in whole blocks; one column where all are alike."""
    image: UInt8[np.ndarray, "height bytes"]
    """Three bytes a pixel."""


@lru_cache(maxsize=64)
def backdrop(lens: Lens, floor: _Colour, ceiling: _Colour, zenith: _Colour | None) -> Backdrop:
    """Paint it.

    The ceiling shades from its colour at the horizon to that of the zenith as the sine of the elevation. The
    row that the horizon parts is all ceiling: `arena.eye.render` paints the floor over it.
    """
    alike = zenith is None or lens.panoramic
    columns = 1 if alike else lens.width
    aside = np.array([np.hypot(*direction(c + 0.5, lens)) for c in range(columns)])
    # Without any rise the quotient below is 0 and not 0/0: the level part of a direction is at least 1, in
    # the middle of a plane and all around a cylinder.
    rise = np.maximum(0.5 * lens.height - np.arange(lens.height) - 0.5, 0.0) / lens.focal
    shade = (rise / np.hypot(aside[:, None], rise))[..., None]
    colours = np.array(ceiling) + shade * (np.subtract(ceiling if zenith is None else zenith, ceiling))
    colours[:, (lens.height + 1) // 2 :] = floor
    # Rounded up with a block to spare: kernels copy whole blocks, from any row on.
    length = -(-(4 * lens.height + BLOCK) // BLOCK) * BLOCK
    painted = np.zeros((columns, length // 4, 4), np.uint8)
    painted[:, : lens.height, :3] = np.rint(colours)
    image = np.empty((lens.height, lens.width, 3), np.uint8)
    image[:] = painted[:, : lens.height, :3].swapaxes(0, 1)
    return Backdrop(painted.reshape(columns, length), image.reshape(lens.height, -1))
