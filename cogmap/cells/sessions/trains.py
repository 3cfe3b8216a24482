"""Spike trains, however they are kept: by cell in a mapping or a list, in a table, by pynapple or neo."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from cogmap.atomic import user_path
from cogmap.cells.sessions.neo_objects import is_neo_train, name_trains, neo_spike_times, neo_trains
from cogmap.cells.sessions.pynapple_objects import is_pynapple, pynapple_trains
from cogmap.cells.sessions.recorded import ONE_POPULATION
from cogmap.cells.sessions.tables import read_spikes, sort_spikes
from cogmap.errors import CogmapError

Trains = dict[str, Float[np.ndarray, "_"]]


def as_trains(source: Any) -> tuple[Trains, list[str]]:
    """Give spike times in s by cell, sorted, and the population of each cell.

    Parameters
    ----------
    source
        A pynapple `TsGroup`; a neo `Segment`, `Block` or list of `SpikeTrain`; spike times by name in a
        mapping, or in a list; a table with columns `cell` and `t` (s), or the path of one.

    Raises
    ------
    CogmapError
        For anything else, and times that are not finite.
    """
    trains, kinds = _read(source)
    if not trains:
        raise CogmapError("the session has no cells; give the spike times of at least one")
    for name, train in trains.items():
        if train.ndim != 1 or not np.isfinite(train).all():
            raise CogmapError(
                f"spike times of cell {name} have shape {train.shape} and must be finite; give a row of s"
            )
    return {name: np.sort(train) for name, train in trains.items()}, kinds


def _read(source: Any) -> tuple[Trains, list[str]]:
    if is_pynapple(source) and hasattr(source, "metadata_columns") and hasattr(source, "keys"):
        return pynapple_trains(source)
    found = neo_trains(source)
    if found is None and isinstance(source, list | tuple) and source and all(map(is_neo_train, source)):
        found = list(source)
    trains = name_trains(found) if found is not None else _plain(source)
    return trains, [ONE_POPULATION] * len(trains)


def _plain(source: Any) -> Trains:
    if isinstance(source, str | Path):
        return read_spikes(user_path(source))
    if isinstance(source, pd.DataFrame):
        return sort_spikes(source)
    if isinstance(source, Mapping):
        return {str(name): _times(train) for name, train in source.items()}
    if isinstance(source, list | tuple) or (isinstance(source, np.ndarray) and source.dtype == object):
        return {str(index): _times(train) for index, train in enumerate(source)}
    raise CogmapError(
        f"a session cannot be made of {type(source).__name__}; give an NWB file, a folder with spikes.csv "
        "and track.csv, objects of pynapple or neo, or a list of spike times for each cell"
    )


def _times(train: Any) -> np.ndarray:
    return neo_spike_times(train) if is_neo_train(train) else np.asarray(train, dtype=float)
