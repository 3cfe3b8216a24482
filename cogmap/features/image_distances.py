"""Distances between images: how different two views are, by pixels, words or the work of moving light."""

from typing import Any

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float
from sklearn.utils import gen_batches

from cogmap.errors import CogmapError
from cogmap.inputs import checked_views

Distances = Float[np.ndarray, "queries views"]

BLOCK = 256
"""Views compared at a time."""
PIXELS = 16_384
"""Grey levels of each compared at a time."""


def pixel_distances(queries: Any, views: Any) -> Distances:
    """Root-mean-square difference of pixel values, 0 to 255.

    Parameters
    ----------
    queries, views
        uint8 images (views, height, width, 3); `views` may lie on disk.

    Raises
    ------
    CogmapError
        For anything but images of one size.
    """
    _check_pair(queries, views)
    pixels = int(np.prod(queries.shape[1:]))
    ours = np.asarray(queries).reshape(-1, pixels)
    squares = np.empty((len(ours), views.shape[0]))
    for block in gen_batches(views.shape[0], BLOCK):
        theirs = np.asarray(views[block]).reshape(-1, pixels)
        squares[:, block] = sum(
            _squared_distances(ours[:, part].astype(float), theirs[:, part].astype(float))
            for part in gen_batches(pixels, PIXELS)
        )
    return np.asarray(np.sqrt(squares) / np.sqrt(pixels))


def _squared_distances(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    # |a - b|² as |a|² + |b|² - 2 a·b, a product of matrices: exact, for these are whole numbers below 2^53.
    lengths = [np.square(rows).sum(axis=1) for rows in (one, other)]
    return np.asarray(np.add.outer(*lengths) - 2 * one @ other.T)


def cosine_distances(queries: sp.csr_array, views: sp.csr_array) -> Distances:
    """1 − cos between bags of words, rows of length one; 1 from a row of zeros."""
    return np.asarray(1 - (queries @ views.T).toarray().astype(np.float64))


def earth_mover_distances(queries: Any, views: Any) -> Distances:
    r"""How far light must be moved around to turn one panoramic strip into another, rad.

    Each colour of a strip is a distribution of light over azimuth, scaled to one. The least work between two
    of them, with cumulative sums F and G over the columns, is

    .. math:: \min_c \sum_j |F_j - G_j - c| \, \Delta, \qquad c = \operatorname{median}_j (F_j - G_j),

    where Δ is the width of a column; the distance is the mean over the colours.

    Parameters
    ----------
    queries, views
        uint8 panoramic strips (views, height, width, 3); `views` may lie on disk.

    Raises
    ------
    CogmapError
        For anything but images of one size.

    References
    ----------
    Rabin, Delon & Gousseau (2011), Transportation distances on the circle.
    """
    _check_pair(queries, views)
    ours = _cumulative_light(np.asarray(queries))
    found = np.empty((queries.shape[0], views.shape[0]))
    for block in gen_batches(views.shape[0], BLOCK):
        theirs = _cumulative_light(np.asarray(views[block]))
        for query, item in enumerate(ours):
            ahead = item - theirs
            ahead -= np.median(ahead, axis=1, keepdims=True)
            found[query, block] = np.abs(ahead).mean(axis=(1, 2))
    return 2 * np.pi * found


def _cumulative_light(strips: np.ndarray) -> Float[np.ndarray, "views columns colours"]:
    # A black strip has no light to move: it counts as evenly lit.
    light = strips.sum(axis=1, dtype=np.float64)
    total = light.sum(axis=1, keepdims=True)
    return np.cumsum(np.where(total > 0, light, 1) / np.where(total > 0, total, light.shape[1]), axis=1)


def _check_pair(queries: Any, views: Any) -> None:
    queries = checked_views(queries)
    views = checked_views(views)
    if tuple(queries.shape[1:]) != tuple(views.shape[1:]):
        raise CogmapError(
            f"queries have shape {tuple(queries.shape[1:])} and views {tuple(views.shape[1:])}; "
            "give images of one size"
        )
