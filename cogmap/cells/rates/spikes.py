"""Spikes: what a recording electrode would have counted."""

from __future__ import annotations

import numpy as np
from jaxtyping import Int

from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, checked_rates

SECONDS = 0.3
"""How long a view lasts: about what a brownian walk takes from one to the next."""


def poisson_spikes(
    rates: AnyArray,
    rng: np.random.Generator,
    *,
    peak: float | None = 20.0,
    seconds: float = SECONDS,
) -> Int[np.ndarray, "views cells"]:
    """Draw how often each cell spikes in each view, n ~ Poisson(λ T), independent of one another.

    Parameters
    ----------
    rates
        In Hz, (views, cells).
    rng
        Where the chance comes from; the same generator state gives the same spikes.
    peak
        Each cell's rates are scaled to this maximum over the views, in Hz; None leaves them as they are.
    seconds
        T, how long a view lasts.

    Raises
    ------
    CogmapError
        For rates that are negative or not finite, a peak or a duration that is not positive.
    """
    rates = checked_rates(rates)
    check_seconds(seconds)
    if peak is not None:
        if not (np.isfinite(peak) and peak > 0):
            raise CogmapError(f"peak is {peak} Hz; give a positive rate, or None to leave the rates alone")
        highest = rates.max(axis=0)
        rates = rates * (peak / np.where(highest > 0, highest, peak))
    return np.asarray(rng.poisson(rates.astype(float) * seconds))


def check_seconds(seconds: float) -> None:
    """Refuse a duration that is not positive.

    Raises
    ------
    CogmapError
        With the duration.
    """
    if not (np.isfinite(seconds) and seconds > 0):
        raise CogmapError(f"a view lasts {seconds} s; give a positive number of seconds")
