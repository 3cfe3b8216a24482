"""Gridness, spacing and orientation: how hexagonal an autocorrelogram is."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int
from scipy import ndimage, sparse

from cogmap.cells.rates.ratios import ratio

STEP_DEG = 3
"""Between directions on the circles that are compared; a divisor of 30."""
CENTRE = 0.2
"""The central peak ends where the mean correlation around the circle is this low, or rises again."""


class Lattice(NamedTuple):
    """The lattice of every cell; NaN without six peaks around the central one."""

    spacing: Float[np.ndarray, "cells"]
    """Mean distance of the six, in bins."""
    orientation: Float[np.ndarray, "cells"]
    """Direction of the peaks modulo 60°, rad, in (−π/6, π/6]."""


def gridness(correlograms: Float[np.ndarray, "cells lags_y lags_x"]) -> Float[np.ndarray, "cells"]:
    """Grid score of autocorrelograms, NaN where nothing is known outside the central peak.

    g = max over outer radii of min(r₆₀, r₁₂₀) − max(r₃₀, r₉₀, r₁₅₀), where r_α is Pearson's correlation of
    the ring from the central peak to the outer radius with itself turned by α: the variant with an expanding
    circle. A ring ends at twice the radius of the central peak or farther, within .8 of the room's shorter
    side. Above 1 for an ideal hexagonal grid; a blob with a ring around it can score as high.

    Source: Langston et al. 2010, Development of the spatial representation system in the rat, Science 328
    (supplement).
    """
    circles = _circles(correlograms)
    radii = circles.shape[1]
    radius = np.arange(radii)[:, None]
    inner = _central_radius(circles)
    # Area counts, so that a turn of the rings is one of the picture.
    weight = np.where(np.isnan(circles), 0.0, radius * (radius >= inner[:, None, None]))
    known = np.nan_to_num(circles)

    def turned(values: np.ndarray, degrees: int) -> np.ndarray:
        return np.roll(values, degrees // STEP_DEG, axis=2)

    def correlation(degrees: int) -> np.ndarray:
        both = np.minimum(weight, turned(weight, degrees))
        one, other = known, turned(known, degrees)
        n, x, y, xx, yy, xy = (
            np.cumsum(np.sum(both * values, axis=2), axis=1)
            for values in (np.ones_like(one), one, other, one**2, other**2, one * other)
        )
        return ratio(n * xy - x * y, np.sqrt(np.maximum((n * xx - x**2) * (n * yy - y**2), 0.0)))

    # Half a turn changes nothing: r₁₂₀ and r₁₅₀ are r₆₀ and r₃₀.
    high, low = correlation(60), np.maximum(correlation(30), correlation(90))
    wide = np.arange(radii) >= np.maximum(2 * inner, inner + 3)[:, None]
    scores = np.where(wide, high - low, np.nan)
    best = np.max(np.nan_to_num(scores, nan=-np.inf), axis=1)
    return np.where(np.isfinite(best), best, np.nan)


def lattice(correlograms: Float[np.ndarray, "cells lags_y lags_x"]) -> Lattice:
    """Measure the spacing and the orientation by the six peaks nearest to the central one.

    A peak is above .1 and higher than its eight neighbours; where it is between bins says the parabola
    through it and two of them, along x and along y.

    Source: Sargolini et al. 2006, Conjunctive representation of position, direction, and velocity in
    entorhinal cortex, Science 312 (supplement).
    """
    y, x = (length // 2 for length in correlograms.shape[1:])
    inner = _central_radius(_circles(correlograms))
    heights = np.nan_to_num(correlograms, nan=-1.0)
    peaks = (ndimage.maximum_filter(heights, size=(1, 3, 3)) == heights) & (heights > 0.1)
    # Opposite peaks are the same twice: half the plane tells all.
    peaks[:, :y] = peaks[:, y, :x] = False
    peaks[:, :, [0, -1]] = peaks[:, [-1]] = False
    cell, row, column = np.nonzero(peaks)
    up = row - y + _between(heights, cell, row, column, (1, 0))
    right = column - x + _between(heights, cell, row, column, (0, 1))
    distance, direction = np.hypot(up, right), np.arctan2(up, right)
    order = np.lexsort((distance, cell))
    order = order[distance[order] > inner[cell[order]]]
    first = np.searchsorted(cell[order], np.arange(len(heights)))
    rank = np.arange(len(order)) - first[cell[order]]
    nearest = order[rank < 3]
    owner, cells = cell[nearest], len(heights)
    three = np.bincount(owner, minlength=cells) == 3
    spacing = np.bincount(owner, distance[nearest], cells) / 3
    sixfold = np.exp(6j * direction[nearest])
    turn = np.arctan2(np.bincount(owner, sixfold.imag, cells), np.bincount(owner, sixfold.real, cells)) / 6
    return Lattice(np.where(three, spacing, np.nan), np.where(three, turn, np.nan))


def _circles(
    correlograms: Float[np.ndarray, "cells lags_y lags_x"],
) -> Float[np.ndarray, "cells radii directions"]:
    """Read correlograms off on circles a bin apart, by bilinear interpolation; NaN next to one."""
    rows, columns = correlograms.shape[1:]
    y, x = rows // 2, columns // 2
    radii = int(0.8 * min(y, x)) + 1
    angle = np.deg2rad(np.arange(0, 360, STEP_DEG))
    at = np.arange(radii)[:, None]
    up, right = (y + at * np.sin(angle)).ravel(), (x + at * np.cos(angle)).ravel()
    low, left = np.floor(up).astype(int), np.floor(right).astype(int)
    corners = [
        ((low + dy) * columns + left + dx, (1 - abs(low + dy - up)) * (1 - abs(left + dx - right)))
        for dy in (0, 1)
        for dx in (0, 1)
    ]
    index, weight = (np.concatenate(parts) for parts in zip(*corners, strict=True))
    point = np.tile(np.arange(len(up)), 4)
    keep = weight > 1e-12
    read = sparse.csr_array((weight[keep], (point[keep], index[keep])), shape=(len(up), rows * columns))
    circles: np.ndarray = (read @ correlograms.reshape(len(correlograms), -1).T).T
    return circles.reshape(-1, radii, len(angle))


def _central_radius(circles: Float[np.ndarray, "cells radii directions"]) -> Int[np.ndarray, "cells"]:
    """How far the central peak reaches, in bins."""
    count = np.sum(~np.isnan(circles), axis=2, dtype=float)
    mean = ratio(np.nansum(circles, axis=2), count)
    over = np.zeros(mean.shape, dtype=bool)
    over[:, 1:] = ~(mean[:, 1:] >= CENTRE)
    over[:, :-1] |= mean[:, 1:] > mean[:, :-1]
    return np.asarray(np.where(over.any(axis=1), over.argmax(axis=1), circles.shape[1]))


def _between(
    heights: Float[np.ndarray, "cells rows columns"],
    cell: Int[np.ndarray, "peaks"],
    row: Int[np.ndarray, "peaks"],
    column: Int[np.ndarray, "peaks"],
    step: tuple[int, int],
) -> Float[np.ndarray, "peaks"]:
    """How far beyond its bin, along an axis, each peak of a parabola is."""
    dy, dx = step
    before, here, after = (heights[cell, row + k * dy, column + k * dx] for k in (-1, 0, 1))
    return np.asarray(np.nan_to_num(ratio(after - before, 2 * (2 * here - before - after))))
