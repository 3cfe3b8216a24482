"""Tuning curves: how much a cell fires in each direction."""

from __future__ import annotations

import numpy as np
from jaxtyping import Complex, Float

from cogmap.cells.bins import heading_bin, means_by_bin
from cogmap.cells.checks import check_samples
from cogmap.cells.ratios import ratio


def tuning_curves(
    rates: Float[np.ndarray, "views cells"], headings: Float[np.ndarray, "views"], bins: int = 36
) -> Float[np.ndarray, "cells bins"]:
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
        For rates that are negative or not finite, shapes that do not fit, fewer than three bins.
    """
    check_samples(rates, headings=headings)
    return means_by_bin(heading_bin(headings, bins), bins, rates).T


def mean_vectors(curves: Float[np.ndarray, "cells bins"]) -> Complex[np.ndarray, "cells"]:
    """Mean vector Σ λ e^{iθ} / Σ λ of tuning curves, NaN for a silent cell; empty bins are left out.

    Its length is 0 for a cell that knows no direction and 1 for one that fires in a single bin, its argument
    is the preferred direction in rad.

    Source: Batschelet 1981, Circular Statistics in Biology, chapter 1.
    """
    bins = curves.shape[1]
    direction = -np.pi + (np.arange(bins) + 0.5) * (2 * np.pi / bins)
    known = np.nan_to_num(curves)
    total = known.sum(axis=1)
    vector = np.sum(known * np.exp(1j * direction), axis=1)
    return ratio(vector, total)
