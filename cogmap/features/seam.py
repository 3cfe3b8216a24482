"""The seam of an image: whether its last column continues in its first, as that of a panorama does."""

from typing import Any, Literal

import numpy as np

from cogmap.inputs import checked_views

Eye = Literal["panorama", "perspective"]
"""What a camera makes of the world: a strip all around, or a picture with borders."""

LOOKED_AT = 250
"""Views by which it is told; spread evenly over those that are given."""
CONTINUES = 0.5
"""Share of the usual correlation of neighbouring columns from which on two columns are neighbours."""
TELLS = 0.3
"""Usual correlation of neighbouring columns below which none are: .9 and more in pictures of a room, about 0
in noise."""


def wraps_around(views: Any) -> bool:
    """Tell from views of a moving scene, or of one that moves, whether they look all around.

    What changes from view to view changes alike in neighbouring columns. If the last and the first column
    change alike, too, they are neighbours: correlations of deviations from the mean view tell, so that a
    still background is no neighbour of its other side, whatever its colour.

    Parameters
    ----------
    views
        (views, height, width, 3) uint8, from different poses.

    Raises
    ------
    CogmapError
        For views that are not uint8 images.
    """
    seam, usual = _likeness_of_neighbours(views)
    return bool(seam >= CONTINUES * usual > 0)


def seam_is_open(views: Any) -> bool:
    """Tell whether views are clearly of an eye with borders.

    Neighbouring columns change alike, but the last and the first do not. Not the opposite of `wraps_around`:
    of views that are all the same, or of noise, neither is so.

    Parameters
    ----------
    views
        (views, height, width, 3) uint8, from different poses.

    Raises
    ------
    CogmapError
        For views that are not uint8 images.
    """
    seam, usual = _likeness_of_neighbours(views)
    return bool(usual >= TELLS and seam < CONTINUES * usual)


def _likeness_of_neighbours(views: Any) -> tuple[float, float]:
    """Correlate what changes in the last and the first column, and in other neighbours (median)."""
    views = checked_views(views)
    chosen = np.unique(np.linspace(0, views.shape[0] - 1, min(LOOKED_AT, views.shape[0])).astype(int))
    # by slices: what is lazy need not know more
    looked_at = [np.asarray(views[view : view + 1], np.float32) for view in chosen.tolist()]
    deviation = np.concatenate(looked_at)
    deviation -= deviation.mean(axis=0)
    columns = deviation.transpose(2, 0, 1, 3).reshape(views.shape[2], -1)
    # Grey levels squared and summed: one keeps what never changes from a division by zero.
    power = np.sqrt(np.square(columns).sum(axis=1)) + 1
    beside = np.roll(columns, -1, axis=0)
    correlation = np.einsum("cv,cv->c", columns, beside) / (power * np.roll(power, -1))
    return float(correlation[-1]), float(np.median(correlation[:-1]))
