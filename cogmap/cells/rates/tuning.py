"""Tuning curves: how much a cell fires in each direction."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Complex, Float

from cogmap.cells.rates.bins import heading_bin, heading_centres, means_by_bin
from cogmap.cells.rates.maps import RateMaps
from cogmap.cells.rates.ratios import ratio
from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, Whole, as_array, as_floats, checked_headings, checked_rates


class Tuning(NamedTuple):
    """Rate maps and tuning curves of a population."""

    maps: RateMaps
    curves: Float[np.ndarray, "cells bins"]
    """`tuning_curves` of the same cells, Hz."""


def tuning_curves(rates: AnyArray, headings: AnyArray, bins: Whole = 36) -> Float[np.ndarray, "cells bins"]:
    """Mean rate of every cell in Hz in equal bins of heading, NaN in a bin without views.

    Each bin is normalised by its own number of views. Bin k is centred at −π + (k + ½) 2π / bins.

    Parameters
    ----------
    rates
        In Hz, (views, cells).
    headings
        In rad, (views,).
    bins
        How many, around the whole circle.

    Raises
    ------
    CogmapError
        For rates that are negative or not finite, shapes that do not fit, headings that are hardly rad, fewer
        than three bins.
    """
    rates = checked_rates(rates)
    headings = checked_headings(headings, len(rates))
    bins = int(bins)
    return means_by_bin(heading_bin(headings, bins), bins, rates).T


def mean_vectors(curves: AnyArray) -> Complex[np.ndarray, "cells"]:
    """Mean vector Σ λ e^{iθ} / Σ λ of tuning curves, NaN for a silent cell.

    Its length is 0 for a cell that knows no direction and 1 for one that fires in a single bin, its argument
    is the preferred direction in rad. An empty bin takes the rate of the first harmonic a + b cos θ + c sin θ
    that fits the others best: without empty bins the vector is that of this harmonic, (b + ic) / 2a, and
    leaving bins out would give any cell a direction away from them.

    Source: Batschelet 1981, Circular Statistics in Biology, chapter 1.
    """
    curves = _as_curves(curves)
    direction = heading_centres(curves.shape[1])
    known = _filled(curves, direction)
    total = known.sum(axis=1)
    vector = np.sum(known * np.exp(1j * direction), axis=1)
    return ratio(vector, total)


def _as_curves(curves: AnyArray) -> Float[np.ndarray, "cells bins"]:
    """Make an array of tuning curves, of which empty bins are NaN."""
    array = as_floats(as_array("curves", curves))
    if array.ndim != 2:
        raise CogmapError(f"curves have shape {array.shape}; give one row per cell, (cells, bins)")
    return array


def _filled(
    curves: Float[np.ndarray, "cells bins"], direction: Float[np.ndarray, "bins"]
) -> Float[np.ndarray, "cells bins"]:
    """Give empty bins the first harmonic of the others, at least 0 Hz; leave all else as it is."""
    empty = np.isnan(curves)
    if not empty.any():
        return curves
    harmonic = np.stack([np.ones_like(direction), np.cos(direction), np.sin(direction)], axis=1)
    gram = np.einsum("cb,bi,bj->cij", (~empty).astype(float), harmonic, harmonic)
    # Bins on one side of the circle do not tell the rate on the other: what they leave open is taken as 0.
    inverse = np.linalg.pinv(gram, rcond=0.01, hermitian=True)
    fitted = np.einsum("cij,bj,ck,ki->cb", inverse, harmonic, np.nan_to_num(curves), harmonic, optimize=True)
    return np.where(empty, np.maximum(fitted, 0.0), curves)


def tuning_widths(curves: AnyArray) -> Float[np.ndarray, "cells"]:
    """Full width in rad at half the peak of tuning curves, NaN for one that is nowhere below, or silent.

    The arc around the highest bin to where the curve first falls through half the peak on either side, by a
    straight line between bins; bins empty for any cell are left out.
    """
    curves = _as_curves(curves)
    seen = np.flatnonzero(~np.isnan(curves).any(axis=0))
    if seen.size == 0:
        return np.full(len(curves), np.nan)
    known = curves[:, seen]
    peak = known.argmax(axis=1)[:, None]
    once_round = (peak + np.arange(seen.size + 1)) % seen.size
    gain = ratio(np.take_along_axis(known, once_round, axis=1), known.max(axis=1, keepdims=True))
    turn = heading_centres(curves.shape[1])[seen][once_round]
    turn = (turn - turn[:, :1]) % (2 * np.pi)
    turn[:, -1] = 2 * np.pi
    return np.asarray(_fall(gain, turn) + _fall(gain[:, ::-1], 2 * np.pi - turn[:, ::-1]))


def _fall(
    gain: Float[np.ndarray, "cells bins"], turn: Float[np.ndarray, "cells bins"]
) -> Float[np.ndarray, "cells"]:
    """How far in rad each curve goes from its peak of 1 to fall through one half, NaN if it does not."""
    below = gain < 0.5
    cell, after = np.arange(len(gain)), below.argmax(axis=1)
    high, low = gain[cell, after - 1], gain[cell, after]
    part = ratio(high - 0.5, high - low)
    near, far = turn[cell, after - 1], turn[cell, after]
    return np.where(below.any(axis=1), near + part * (far - near), np.nan)
