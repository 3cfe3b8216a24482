"""Every cell measured both as a place cell and as a head-direction cell, in one table."""

from __future__ import annotations

import numpy as np
import pandas as pd

OF_HEADING = ("preferred_direction_rad", "mean_vector_length", "drift_deg")


def join_statistics(place: pd.DataFrame, heading: pd.DataFrame | None) -> pd.DataFrame:
    """Join `place_statistics` and `heading_statistics` of the same cells.

    The two columns `passing` are `place_passing` and `heading_passing`, and the spatial information of the
    second is `spatial_information_beyond_heading`. Without headings its columns are NaN, and no cell passes
    as a head-direction cell.
    """
    if heading is None:
        unknown = dict.fromkeys((*OF_HEADING, "spatial_information"), np.nan)
        heading = pd.DataFrame({**unknown, "passing": False}, index=place.index)
    mine = heading[list(OF_HEADING)].assign(spatial_information_beyond_heading=heading["spatial_information"])
    table = place.drop(columns="passing").join(mine)
    return table.assign(place_passing=place["passing"], heading_passing=heading["passing"])
