"""Objects of pynapple: groups of spike trains, series of positions and headings."""

from __future__ import annotations

from typing import Any

import numpy as np
from jaxtyping import Float

from cogmap.cells.sessions.recorded import ONE_POPULATION, Series

CELL_TYPE = "cell_type"
"""The column that sorts cells into populations, here and in NWB."""


def is_pynapple(value: object) -> bool:
    """Whether pynapple made it; asked without an import of pynapple, which takes seconds."""
    return type(value).__module__.startswith("pynapple.")


def pynapple_trains(group: Any) -> tuple[dict[str, Float[np.ndarray, "_"]], list[str]]:
    """Give the spike times (s) of a `TsGroup` by cell, and the population of each."""
    trains = {str(key): np.asarray(group[key].times(), dtype=float) for key in group}
    sorted_into = CELL_TYPE in group.metadata_columns
    kinds = [str(kind) for kind in group[CELL_TYPE]] if sorted_into else [ONE_POPULATION] * len(trains)
    return trains, kinds


def pynapple_series(series: Any) -> Series:
    """Give times and values of a `Tsd` or `TsdFrame`, which knows no unit."""
    return Series(np.asarray(series.times(), dtype=float), np.asarray(series.values, dtype=float), None)
