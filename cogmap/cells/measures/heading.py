"""Statistics of head-direction cells, and what makes a cell one."""

from __future__ import annotations

import numpy as np
import pandas as pd
from jaxtyping import Complex, Float

from cogmap.cells.measures.information import information_per_spike
from cogmap.cells.measures.place_by_direction import place_by_direction
from cogmap.cells.measures.rayleigh import rayleigh_test
from cogmap.cells.measures.stability import curve_stability
from cogmap.cells.rates.bins import BinEdges
from cogmap.cells.rates.maps import RateMaps, rate_maps
from cogmap.cells.rates.spikes import SECONDS, check_seconds
from cogmap.cells.rates.tuning import mean_vectors, tuning_curves, tuning_widths
from cogmap.inputs import AnyArray, checked_array, checked_headings, checked_rates

LEAST_VECTOR = 0.5
"""A head-direction cell's mean vector is longer."""
MOST_INFORMATION = 0.3
"""bit/spike; a head-direction cell tells less about the place."""


def heading_statistics(
    rates: AnyArray,
    positions: AnyArray,
    headings: AnyArray,
    *,
    maps: RateMaps | None = None,
    smoothing: float = 0.15,
    seconds: float = SECONDS,
    least_vector: float = LEAST_VECTOR,
    most_drift_deg: float = 15.0,
    most_information: float = MOST_INFORMATION,
) -> pd.DataFrame:
    """Measure every cell as a head-direction cell: one row per cell, one column per statistic.

    Unless told, a cell passes with a mean vector longer than .5, a drift below 15° and < 0.3 bit/spike.

    Parameters
    ----------
    rates
        In Hz, (views, cells).
    positions
        In m, (views, 2).
    headings
        In rad, (views,).
    maps
        The rate maps of these cells; by default `rate_maps(rates, positions)`.
    smoothing
        Of the maps, m.
    seconds
        How long a view lasts; with the rates it says how many spikes the Rayleigh test has.
    least_vector
        A head-direction cell's mean vector is longer.
    most_drift_deg
        A head-direction cell drifts less over the room.
    most_information
        bit/spike; a head-direction cell tells less about the place.

    Returns
    -------
    pandas.DataFrame
        `preferred_direction_rad`, `mean_vector_length` and `tuning_width_deg` (at half height; 36
        occupancy-normalised bins), `rayleigh_p` (of as many spikes as the rates make), `stability`
        (correlation of the curves of both halves), `drift_deg` (median
        over 3×3 blocks of the room of the angle between the preferred direction there, from 12 bins, and
        everywhere; blocks with fewer than 100 views are left out), `spatial_information` (bit/spike, of the
        map in `place_by_direction`: in a plain one the directions in which each place was seen tell of the
        place, .4 bit/spike with 2,500 views of 9×6 m), `passing`. NaN where a silent cell has no value.

    Raises
    ------
    CogmapError
        For rates that are negative or not finite, shapes that do not fit, headings that are hardly rad, maps
        of other cells.
    """
    rates = checked_rates(rates)
    positions = checked_array("positions", positions, (len(rates), 2))
    headings = checked_headings(headings, len(rates))
    maps = rate_maps(rates, positions) if maps is None else maps.of_cells(rates.shape[1])
    check_seconds(seconds)
    curves = tuning_curves(rates, headings)
    vector = mean_vectors(curves)
    everywhere = np.broadcast_to(maps.visited, maps.rates.shape)
    apart = place_by_direction(
        rates, positions, headings, maps, everywhere, bins=curves.shape[1], smoothing=smoothing
    )
    length, information = np.abs(vector), information_per_spike(apart.exposure, apart.rates)
    drift = np.rad2deg(_drift(rates, positions, headings, vector))
    columns = {
        "preferred_direction_rad": np.angle(vector),
        "mean_vector_length": length,
        "tuning_width_deg": np.rad2deg(tuning_widths(curves)),
        "rayleigh_p": rayleigh_test(rates * seconds, headings).p_value,
        "stability": curve_stability(rates, headings),
        "drift_deg": drift,
        "spatial_information": information,
        "passing": (length > least_vector) & (drift < most_drift_deg) & (information < most_information),
    }
    return pd.DataFrame(columns).rename_axis("cell")


def _drift(
    rates: Float[np.ndarray, "views cells"],
    positions: Float[np.ndarray, "views 2"],
    headings: Float[np.ndarray, "views"],
    vector: Complex[np.ndarray, "cells"],
) -> Float[np.ndarray, "cells"]:
    """Median over blocks of the room of |preferred direction there − everywhere|, rad.

    100 views tell a preferred direction to about 2°; bins are coarser than over the whole room, so that those
    of a block have views.
    """
    blocks, least_views, bins = 3, 100, 12
    edges = np.linspace(positions.min(axis=0), positions.max(axis=0), blocks + 1)
    block = BinEdges(*edges.T).bin_of(positions)
    turns = [
        np.abs(np.angle(mean_vectors(tuning_curves(rates[here], headings[here], bins)) * vector.conj()))
        for here in (block == index for index in range(blocks**2))
        if here.sum() >= least_views
    ]
    return pd.DataFrame(turns, columns=range(rates.shape[1])).median().to_numpy(dtype=float)
