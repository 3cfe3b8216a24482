"""Turning a panorama: its columns shift around the circle, by fractions of a column as well."""

from __future__ import annotations

import typing
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Float32, UInt8

from arena.angles import wrap_angle
from cogmap.kernels import kernel


def columns_turned(turn: Float[np.ndarray, "*shape"], width: int) -> Float32[np.ndarray, "*shape"]:
    """Give the columns by which a panorama shifts to the right when the body turns left by so much (rad)."""
    return np.asarray(wrap_angle(turn) * width / (2 * np.pi), np.float32)


class Painted(NamedTuple):
    """A panorama put together from several, and how far these agree."""

    view: Float32[np.ndarray, "height width 3"]
    spread: Float32[np.ndarray, "height width"]
    """Root mean square difference of what the sources show, weighted by `near`, grey levels."""


def blended(
    views: UInt8[np.ndarray, "sources height width 3"],
    shifts: Float32[np.ndarray, "sources"],
    affine: Float32[np.ndarray, "sources"],
    near: Float32[np.ndarray, "sources"],
) -> Painted:
    """Shift panoramas by columns to the right, each by its own, and mix them by their affine weights.

    What changes linearly with place comes out right, and what moves by more than a blur of it is doubled.
    Between columns a panorama is cubic (Catmull & Rom 1974), which keeps detail that a straight line would
    blur.
    """
    return Painted(*_blended(views, shifts, affine, near))


@kernel(nogil=True, fastmath={"contract"})
@typing.no_type_check
def _blended(
    views: np.ndarray, shifts: np.ndarray, affine: np.ndarray, near: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    sources, height, width, _ = views.shape
    mixed = np.zeros((height, width, 3), np.float32)
    spread = np.zeros((height, width), np.float32)
    ring = np.empty((width + 3) * 3, np.float32)
    shifted = np.empty(width * 3, np.float32)
    total, squares = np.empty(width * 3, np.float32), np.empty(width * 3, np.float32)
    half = np.float32(0.5)
    for row in range(height):
        total[:] = 0
        squares[:] = 0
        blend = mixed[row].reshape(-1)
        for source in range(sources):
            if near[source] == 0:
                continue
            whole = np.floor(shifts[source])
            # column c is read at c − shift: between two columns, b after the left one
            b = np.float32(1) - np.float32(shifts[source] - whole)
            before = half * (-b + 2 * b * b - b * b * b)
            left = half * (2 - 5 * b * b + 3 * b * b * b)
            right = half * (b + 4 * b * b - 3 * b * b * b)
            after = half * (b * b * b - b * b)
            first = (-int(whole) - 2) % width
            line = views[source, row].reshape(-1)
            seam, again = 3 * (width - first), min(3 * (first + 3), 3 * width)
            ring[:seam] = line[3 * first :]
            ring[seam : seam + again] = line[:again]
            ring[seam + again :] = line[: 3 * (first + 3) - again]
            for value in range(3 * width):
                shifted[value] = (
                    before * ring[value]
                    + left * ring[value + 3]
                    + right * ring[value + 6]
                    + after * ring[value + 9]
                )
            for value in range(3 * width):
                blend[value] += affine[source] * shifted[value]
                total[value] += near[source] * shifted[value]
                squares[value] += near[source] * shifted[value] * shifted[value]
        for column in range(width):
            variance = np.float32(0)
            for value in range(3 * column, 3 * column + 3):
                variance += max(np.float32(0), squares[value] - total[value] * total[value])
            spread[row, column] = np.sqrt(variance / 3)
    return mixed, spread
