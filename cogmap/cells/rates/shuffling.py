"""Shuffling: what a statistic would be if a cell knew nothing of the walk, its null distribution."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Real

from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, checked_rates


class ShuffleTest(NamedTuple):
    """A statistic of every cell beside its null; NaN where it has no value."""

    observed: Float[np.ndarray, "cells"]
    shuffled: Float[np.ndarray, "shuffles cells"]
    p_value: Float[np.ndarray, "cells"]
    """Chance that a cell that knows nothing reaches what was observed, at least 1 / (shuffles + 1)."""


def shuffle_test(
    statistic: Callable[[Real[np.ndarray, "views cells"]], Float[np.ndarray, "cells"]],
    rates: AnyArray,
    rng: np.random.Generator,
    *,
    shuffles: int = 100,
    least_shift: int = 100,
) -> ShuffleTest:
    """Compare a statistic with that of rates shifted in time around the recording's circle.

    Shifting keeps how a cell fires in time and how the animal walks, and breaks the tie between them. All
    cells shift together. p = (1 + number of shuffles that reach what was observed) / (1 + shuffles).

    Parameters
    ----------
    statistic
        From rates (views, cells) to one number per cell, large when it matters, for example
        `lambda rates: spatial_information(rate_maps(rates, positions))`.
    rates
        In Hz or spikes, (views, cells), in the order of time.
    rng
        Draws the shifts.
    shuffles
        How many.
    least_shift
        Views by which rates are shifted at least, forward or backward. 100 are about 30 s of a walk: by then
        the animal is elsewhere.

    Raises
    ------
    CogmapError
        For rates that are negative or not finite, too few views for the shift, no shuffle.

    References
    ----------
    Langston et al. 2010, Development of the spatial representation system in the rat, Science 328. Phipson &
    Smyth 2010, Permutation p-values should never be zero, Stat. Appl. Genet. Mol. Biol. 9.
    """
    rates = checked_rates(rates)
    if shuffles < 1:
        raise CogmapError(f"{shuffles} shuffles make no null; give at least 1")
    if not 1 <= least_shift <= len(rates) // 2:
        raise CogmapError(
            f"{len(rates)} views cannot shift by {least_shift} either way; "
            f"give a least_shift from 1 to {len(rates) // 2}"
        )
    observed = statistic(rates)
    shifts = rng.integers(least_shift, len(rates) - least_shift, shuffles, endpoint=True)
    shuffled = np.stack([statistic(np.roll(rates, shift, axis=0)) for shift in shifts])
    # A shuffle without a value speaks against the cell.
    reached = np.sum(~(shuffled < observed), axis=0)
    return ShuffleTest(
        observed, shuffled, np.where(np.isnan(observed), np.nan, (1 + reached) / (1 + shuffles))
    )
