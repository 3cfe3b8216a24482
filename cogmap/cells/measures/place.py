"""Statistics of place cells, and what makes a cell one."""

from __future__ import annotations

import numpy as np
import pandas as pd

from cogmap.cells.measures.coherence import coherence
from cogmap.cells.measures.fields import PlaceFields, place_fields
from cogmap.cells.measures.information import selectivity, sparsity, spatial_information
from cogmap.cells.measures.place_by_direction import place_by_direction
from cogmap.cells.measures.stability import map_stability
from cogmap.cells.rates.maps import RateMaps, rate_maps
from cogmap.cells.rates.tuning import mean_vectors
from cogmap.inputs import AnyArray, checked_array, checked_headings, checked_rates

LEAST_INFORMATION = 0.5
"""bit/spike; a place cell has more."""
MOST_DIRECTION = 0.25
"""A place cell's direction vector inside its field is shorter."""


def place_statistics(
    rates: AnyArray,
    positions: AnyArray,
    headings: AnyArray | None,
    *,
    maps: RateMaps | None = None,
    fields: PlaceFields | None = None,
    smoothing: float = 0.15,
    least_information: float = LEAST_INFORMATION,
    most_direction: float = MOST_DIRECTION,
) -> pd.DataFrame:
    """Measure every cell as a place cell: one row per cell, one column per statistic.

    Unless told, a cell passes with exactly one field, more than 0.5 bit/spike and an in-field direction
    vector below .25.

    Parameters
    ----------
    rates
        In Hz, (views, cells).
    positions
        In m, (views, 2).
    headings
        In rad, (views,); None when nobody knows them: direction is then no part of passing.
    maps
        The rate maps of these cells; by default `rate_maps(rates, positions)`.
    fields
        The fields in these maps; by default `place_fields(maps)`.
    smoothing
        Of the maps, m.
    least_information
        bit/spike; a place cell has more.
    most_direction
        A place cell's direction vector inside its field is shorter.

    Returns
    -------
    pandas.DataFrame
        `peak_rate_hz` of the map, `mean_rate_hz` over the views, `fields`, `field_area_m2` and `centre_x_m`,
        `centre_y_m` of the largest field, `spatial_information` (bit/spike), `sparsity`, `selectivity`,
        `coherence` (of the map without smoothing), `stability` (correlation of the maps of both halves),
        `in_field_direction_vector` (length of the mean vector inside the fields, 12 bins of the curve in
        `place_by_direction`: a plain one tells where in the field each direction was looked in), `passing`.
        NaN where a silent cell or one without a field has no value.

    Raises
    ------
    CogmapError
        For rates that are negative or not finite, shapes that do not fit, headings that are hardly rad, maps
        of other cells.
    """
    rates = checked_rates(rates)
    positions = checked_array("positions", positions, (len(rates), 2))
    headings = None if headings is None else checked_headings(headings, len(rates))
    maps = rate_maps(rates, positions, smoothing=smoothing) if maps is None else maps.of_cells(rates.shape[1])
    fields = place_fields(maps) if fields is None else fields
    edges = maps.edges
    unsmoothed = rate_maps(rates, positions, edges.side, 0.0, edges=edges, visited=maps.visited)
    direction, undirected = np.full(len(maps), np.nan), True
    if headings is not None:
        apart = place_by_direction(
            rates, positions, headings, maps, fields.masks, bins=12, smoothing=smoothing
        )
        direction = np.abs(mean_vectors(apart.gains))
        undirected = direction < most_direction
    information, single = spatial_information(maps), fields.number == 1
    columns = {
        "peak_rate_hz": np.nanmax(maps.rates, axis=(1, 2)),
        "mean_rate_hz": rates.mean(axis=0, dtype=float),
        "fields": fields.number,
        "field_area_m2": fields.area,
        "centre_x_m": fields.centre[:, 0],
        "centre_y_m": fields.centre[:, 1],
        "spatial_information": information,
        "sparsity": sparsity(maps),
        "selectivity": selectivity(maps),
        "coherence": coherence(unsmoothed),
        "stability": map_stability(rates, positions, edges, smoothing),
        "in_field_direction_vector": direction,
        "passing": single & (information > least_information) & undirected,
    }
    return pd.DataFrame(columns).rename_axis("cell")
