"""The Rayleigh test: whether spikes prefer a direction at all."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from cogmap.cells.rates.bins import heading_bin
from cogmap.cells.rates.ratios import ratio
from cogmap.inputs import AnyArray, Whole, checked_headings, checked_rates


class RayleighTest(NamedTuple):
    """Of every cell; NaN with no more than one spike, which always has a direction."""

    z: Float[np.ndarray, "cells"]
    """n R², where R is the length of the mean direction of n spikes."""
    p_value: Float[np.ndarray, "cells"]
    """Chance of so large a z when every direction is as likely as any other."""


def rayleigh_test(spikes: AnyArray, headings: AnyArray, bins: Whole | None = 36) -> RayleighTest:
    """Test every cell for uniformity of its spikes over the circle, against one preferred direction.

    z = n R² and p = e⁻ᶻ (1 + (2z − z²) / 4n − (24z − 132z² + 76z³ − 9z⁴) / 288n²), the bracket only for
    n < 50. An animal does not look everywhere equally often, so each spike weighs w, one over the number of
    views in its bin of heading; n is then the effective number (Σ w)² / Σ w², which keeps the variance.

    Parameters
    ----------
    spikes
        How often each cell fired in each view, (views, cells); rates times seconds give the expected test.
    headings
        In rad, (views,).
    bins
        Of heading, for the weights; None for spikes as they come, the textbook's test.

    Raises
    ------
    CogmapError
        For spikes that are negative or not finite, shapes that do not fit, fewer than three bins.

    References
    ----------
    Wilkie 1983, Rayleigh test for randomness of circular data, Applied Statistics 32; Mardia & Jupp 2000,
    Directional Statistics, chapter 6. Kish 1965, Survey Sampling (effective number).
    """
    spikes = checked_rates(spikes)
    headings = checked_headings(headings, len(spikes))
    weight = np.ones(len(headings))
    if bins is not None:
        index = heading_bin(headings, int(bins))
        weight = 1 / np.bincount(index, minlength=int(bins))[index]
    across, along = weight * np.cos(headings), weight * np.sin(headings)
    total, x, y, square = np.stack([weight, across, along, weight**2]) @ spikes.astype(float)
    number, resultant = ratio(total**2, square), ratio(np.hypot(x, y), total)
    number = np.where(number > 1, number, np.nan)
    z = number * resultant**2
    second = 24 * z - 132 * z**2 + 76 * z**3 - 9 * z**4
    bracket = np.where(number < 50, 1 + (2 * z - z**2) / (4 * number) - second / (288 * number**2), 1.0)
    return RayleighTest(z, np.clip(np.exp(-z) * bracket, 0.0, 1.0))
