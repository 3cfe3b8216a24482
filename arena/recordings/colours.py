"""Colours of pictures from anywhere: whatever cameras and programs give, made 8-bit RGB."""

from typing import Any

import numpy as np
from jaxtyping import UInt8

from arena.errors import ArenaError

Picture = UInt8[np.ndarray, "height width 3"]
ROUNDING = 1e-6
"""By so much a grey level may lie outside 0 to 1: filters round."""


def as_rgb(picture: Any, label: str) -> Picture:
    """Make a picture 8-bit RGB.

    Parameters
    ----------
    picture
        (height, width) or (height, width, 1) is grey, (…, 3) RGB, (…, 4) RGB and how opaque, which is left
        out. Bytes are taken as they are, 16 bit are divided by 257, floats are from 0 (black) to 1, and
        truth values are black and white.
    label
        What errors call it.

    Raises
    ------
    ArenaError
        For other shapes, and for numbers that may mean anything.
    """
    values = np.asarray(picture)
    if values.ndim == 2:
        values = values[..., None]
    if values.ndim != 3 or values.shape[2] not in {1, 3, 4} or not values.size:
        first = values.ndim == 3 and values.shape[0] in {1, 3, 4} and values.shape[2] > 4
        there = "transpose it: its colours come first" if first else "(height, width), or with 1, 3 or 4 last"
        raise ArenaError(f"{label} is of shape {np.shape(picture)}; {there}")
    levels = _levels(values[..., :3], label)
    return np.ascontiguousarray(np.broadcast_to(levels, (*values.shape[:2], 3)))


def _levels(values: np.ndarray, label: str) -> UInt8[np.ndarray, "height width colours"]:
    """Make grey levels bytes."""
    if values.dtype == np.uint8:
        return values
    if values.dtype.kind == "b":
        return values * np.uint8(255)
    if values.dtype.kind == "u" and values.dtype.itemsize == 2:
        # White is 65535 = 255 · 257, and an odd divisor leaves no ties.
        return ((values.astype(np.uint32) + 128) // 257).astype(np.uint8)
    if values.dtype.kind != "f":
        raise ArenaError(
            f"{label} is {values.dtype}, whose white may be anything; give uint8, uint16, or floats to 1"
        )
    low, high = values.min(), values.max()
    if not (low >= -ROUNDING and high <= 1 + ROUNDING):
        raise ArenaError(
            f"{label} has values from {low:g} to {high:g}; floats go from 0 (black) to 1 (white): divide "
            "them, or make them uint8"
        )
    levels: np.ndarray = np.rint(np.clip(values, 0, 1) * 255).astype(np.uint8)
    return levels
