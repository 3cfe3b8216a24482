"""Stability: whether a cell is tuned the same in both halves of a recording."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from cogmap.cells.measures.correlations import correlations
from cogmap.cells.rates.bins import BinEdges
from cogmap.cells.rates.maps import rate_maps
from cogmap.cells.rates.tuning import tuning_curves
from cogmap.inputs import AnyArray, Whole, checked_array, checked_headings, checked_rates


def map_stability(
    rates: AnyArray, positions: AnyArray, edges: BinEdges, smoothing: float = 0.15
) -> Float[np.ndarray, "cells"]:
    """Correlation between the rate maps of the first and of the second half of the views.

    Over the bins visited in both, with this `smoothing` in m; views outside the edges are left out.
    NaN where a half is constant.

    Source: Langston et al. 2010, Development of the spatial representation system in the rat, Science 328.
    """
    rates = checked_rates(rates)
    positions = checked_array("positions", positions, (len(rates), 2))
    inside = np.flatnonzero(edges.bin_of(positions) >= 0)
    if len(inside) < 2:
        return np.full(rates.shape[1], np.nan)
    first, second = (
        rate_maps(rates[half], positions[half], edges.side, smoothing, edges=edges).rates.reshape(
            rates.shape[1], -1
        )
        for half in np.array_split(inside, 2)
    )
    return correlations(first, second)


def curve_stability(rates: AnyArray, headings: AnyArray, bins: Whole = 36) -> Float[np.ndarray, "cells"]:
    """Correlation between the tuning curves of the first and of the second half of the views.

    Over the bins looked at in both; NaN where a half is constant. Source: as `map_stability`.
    """
    rates = checked_rates(rates)
    headings = checked_headings(headings, len(rates))
    if len(rates) < 2:
        return np.full(rates.shape[1], np.nan)
    first, second = (
        tuning_curves(rates[half], headings[half], bins) for half in np.array_split(np.arange(len(rates)), 2)
    )
    return correlations(first, second)
