"""Panoramic strips as Fourier series along azimuth."""

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Complex64, Float32
from scipy import fft

from cogmap.errors import CogmapError
from cogmap.inputs import checked_views

FREQUENCIES = 31
"""Kept: of constant to 30 periods around the circle."""
BLOCK = 512
"""Views read at a time."""


class Strips(NamedTuple):
    """Fourier series of panoramas, the same for their brightness and without what a turn changes."""

    grey: Complex64[np.ndarray, "views rows frequencies"]
    """Of the brightness; a turn to the left by Δ multiplies frequency f by exp(−i f Δ)."""
    turn_invariant: Float32[np.ndarray, "views features"]
    """Magnitudes for each row, colour and frequency: a turn does not change them."""


def strips(views: Any) -> Strips:
    """Take panoramas (views, height, width, 3) apart; they are read block by block and may lie on disk.

    Raises
    ------
    CogmapError
        For views that are not uint8 images, or narrower than 62 columns.
    """
    views = checked_views(views)
    count, height, width, _ = views.shape
    if width < 2 * FREQUENCIES:
        raise CogmapError(f"panoramas are {width} columns wide; give at least {2 * FREQUENCIES}")
    # Ten rows are kept at most; neighbouring rows are averaged.
    edges = np.unique(np.linspace(0, height, min(10, height) + 1).astype(int))
    grey = np.empty((count, len(edges) - 1, FREQUENCIES), np.complex64)
    turn_invariant = np.empty((count, 3 * (len(edges) - 1) * FREQUENCIES), np.float32)
    share = np.diff(edges).astype(np.float32)[:, None, None]
    for first in range(0, count, BLOCK):
        block = np.asarray(views[first : first + BLOCK]).astype(np.float32)
        rows = np.add.reduceat(block, edges[:-1], axis=1) / share
        series = fft.rfft(rows, axis=2)[:, :, :FREQUENCIES] / width
        grey[first : first + BLOCK] = series.mean(axis=3)
        turn_invariant[first : first + BLOCK] = np.abs(series).reshape(len(block), -1)
    return Strips(grey, turn_invariant)
