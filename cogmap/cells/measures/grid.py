"""Statistics of grid cells, and what makes a cell one."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice

import numpy as np
import pandas as pd

from cogmap.cells.measures.autocorrelogram import autocorrelograms
from cogmap.cells.measures.fields import place_fields
from cogmap.cells.measures.grid_nulls import band_noise, shuffled_fields
from cogmap.cells.measures.gridness import gridness, lattice
from cogmap.cells.rates.maps import RateMaps
from cogmap.inputs import checked_count


def grid_statistics(
    maps: RateMaps, *, shuffles: int = 100, seed: int = 0, least_fields: int = 4, most_p: float = 0.05
) -> pd.DataFrame:
    """Measure every cell as a grid cell: one row per cell, one column per statistic.

    Unless told, a cell passes with four fields or more and a gridness that less than 5 % of the maps of its
    band noise, and less than 5 % of the shuffles of its fields, reach. The score alone will not do: a blob
    with a ring around it can have that of a grid.

    Parameters
    ----------
    maps
        From `rate_maps`; the smoothing should be less than a fifth of the spacing.
    shuffles
        Maps of each null.
    seed
        Draws the nulls.
    least_fields
        A grid cell has at least so many.
    most_p
        A grid cell's p-values are lower.

    Returns
    -------
    pandas.DataFrame
        `gridness`, `spacing_m`, `orientation_rad` (of the six peaks of the autocorrelogram, modulo 60°, in
        (−π/6, π/6]), `fields` (regions more than half way from the lowest to the highest rate),
        `band_noise_p` and `field_shuffle_p` (chance of such a gridness, at least 1 / (shuffles + 1)),
        `passing`. NaN where a constant map has no value.

    Raises
    ------
    CogmapError
        When there is no shuffle.
    """
    checked_count("shuffles", shuffles)
    # A dense grid has a rate between its fields: they are counted above the lowest.
    above = replace(maps, rates=maps.rates - np.nanmin(maps.rates, axis=(1, 2), keepdims=True))
    fields = place_fields(above, threshold=0.5)
    correlograms = autocorrelograms(maps)
    score, (spacing, orientation) = gridness(correlograms), lattice(correlograms)
    nulls = {
        "band_noise_p": band_noise(above, np.random.default_rng([seed, 0])),
        "field_shuffle_p": shuffled_fields(above, fields, np.random.default_rng([seed, 1])),
    }
    chances = {}
    for name, draws in nulls.items():
        reached = [~(gridness(autocorrelograms(null)) < score) for null in islice(draws, shuffles)]
        chances[name] = (1 + np.sum(reached, axis=0)) / (1 + shuffles)
    unlikely = np.max(list(chances.values()), axis=0) < most_p
    columns = {
        "gridness": score,
        "spacing_m": spacing * maps.edges.side,
        "orientation_rad": orientation,
        "fields": fields.number,
        **{name: np.where(np.isnan(score), np.nan, chance) for name, chance in chances.items()},
        "passing": (fields.number >= least_fields) & unlikely,
    }
    return pd.DataFrame(columns).rename_axis("cell")
