"""Spatial autocorrelogram: how a rate map correlates with itself, shifted."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy import fft

from cogmap.cells.rates.maps import RateMaps
from cogmap.cells.rates.ratios import ratio

LEAST_OVERLAP = 20
"""Bins that a map and its shifted copy must share for a correlation."""


def autocorrelograms(maps: RateMaps) -> Float[np.ndarray, "cells lags_y lags_x"]:
    """Correlate every rate map with itself at each shift by whole bins, over the bins visited in both.

    The shape is (cells, 2 ny − 1, 2 nx − 1) with no shift in the middle, 1 there. Pearson's r, by FFT; NaN
    where fewer than 20 bins overlap or the rates there are constant.

    Source: Sargolini et al. 2006, Conjunctive representation of position, direction, and velocity in
    entorhinal cortex, Science 312 (supplement).
    """
    sides = maps.visited.shape
    shape = [fft.next_fast_len(2 * side - 1, real=True) for side in sides]
    rows, columns = (np.arange(1 - side, side) % length for side, length in zip(sides, shape, strict=True))
    visited = maps.visited.astype(float)
    # About their mean: sums of squares that cancel lose fewer digits.
    rates = np.where(maps.visited, maps.rates - maps.patterns.mean(axis=1)[:, None, None], 0.0)
    known, first, second = (fft.rfft2(values, shape) for values in (visited, rates, rates**2))

    def correlate(one: np.ndarray, other: np.ndarray) -> np.ndarray:
        return np.asarray(fft.irfft2(one.conj() * other, shape)[..., rows[:, None], columns])

    count = np.rint(correlate(known, known))
    sums, squares, products = correlate(first, known), correlate(second, known), correlate(first, first)
    # The other map's sums are those of the opposite shift.
    ahead, squares_ahead = sums[:, ::-1, ::-1], squares[:, ::-1, ::-1]
    spread, spread_ahead = count * squares - sums**2, count * squares_ahead - ahead**2
    # What varies less than this is constant: the rest is rounding.
    size = 1e-9 * np.sum(rates**2, axis=(1, 2)) + 1e-18 * np.sum(maps.patterns**2, axis=1)
    least = count * size[:, None, None]
    enough = (count >= LEAST_OVERLAP) & (np.minimum(spread, spread_ahead) > least)
    scale = np.sqrt(np.where(enough, spread * spread_ahead, 0.0))
    return np.asarray(np.clip(ratio(count * products - sums * ahead, scale), -1.0, 1.0))
