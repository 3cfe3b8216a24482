"""Files of plain tables: a track, and the spikes beside it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from arena import read_track
from arena.angles import wrap_angle
from arena.recordings.columns import read_columns
from cogmap.cells.sessions.recorded import Track, track_of
from cogmap.cells.sessions.units import DIGITS, metres_per
from cogmap.errors import CogmapError

SPIKES, TRACK = "spikes.csv", "track.csv"
"""In the folder of a session."""


def read_track_file(
    path: Path,
    *,
    unit: str | None = None,
    metres_per_unit: object = None,
    heading_unit: str | None = None,
    **options: Any,
) -> Track:
    """Read where the animal was, in metres and radians, with what was judged of it in the notes.

    Parameters
    ----------
    path
        A tracker's file, as `arena.read_track` takes it.
    unit, metres_per_unit
        Of its positions, in place of the options `scale` and `calibration`.
    heading_unit
        "rad" or "deg", in place of the option `heading_in`.
    options
        Those of `arena.recordings.track_format.TrackFormat`: `bodypart`, `rate`, `missing`, ...

    Raises
    ------
    ArenaError
        When it cannot be read, for options that are unknown or at odds.
    CogmapError
        For a unit that is none.
    """
    if unit is not None or metres_per_unit is not None:
        scaled = [name for name in ("scale", "calibration") if name in options]
        if scaled:
            raise CogmapError(f"both a unit and {scaled[0]} are given; leave one of them out")
        options["scale"] = metres_per(None, unit, metres_per_unit)
    if heading_unit is not None:
        options["heading_in"] = heading_unit
    found = read_track(path, **options)
    # As `scaled` does: trackers give whole centimetres or pixels.
    headings = None if found.headings is None else wrap_angle(found.headings)
    track = track_of(found.times, found.positions.round(DIGITS), headings, unit="m", heading_unit="rad")
    return replace(track, notes=found.notes)


def read_spikes(path: Path) -> dict[str, Float[np.ndarray, "_"]]:
    """Read spike times (s) by cell from a file with the columns `cell` and `t`, one row a spike.

    Raises
    ------
    ArenaError
        When it cannot be read, or lacks a column.
    CogmapError
        When it holds a time that is no number.
    """
    columns, _ = read_columns(path, ("cell", "t"), words=("cell",))
    return sort_spikes(pd.DataFrame(columns), str(path))


def sort_spikes(table: pd.DataFrame, whose: str = "the table of spikes") -> dict[str, Float[np.ndarray, "_"]]:
    """Give spike times (s) by cell, of a table with the columns `cell` and `t`; numbers in their order.

    Raises
    ------
    CogmapError
        When a column is missing, or a value in one.
    """
    if not {"cell", "t"} <= set(table.columns):
        raise CogmapError(
            f"{whose} has columns {', '.join(map(str, table.columns))}; it must have cell and t (s), one row "
            "a spike"
        )
    times = pd.to_numeric(table["t"], errors="coerce").to_numpy(dtype=float)
    wrong = np.flatnonzero(~np.isfinite(times) | (table["cell"].isna() | (table["cell"] == "")).to_numpy())
    if len(wrong):
        row = table.iloc[wrong[0]]
        raise CogmapError(
            f"{whose}: spike {wrong[0] + 1} has cell = {row['cell']} and t = {row['t']}; give a name and a "
            "finite number of s"
        )
    cells = table["cell"].astype(str).str.strip()
    spikes = pd.Series(times).groupby(cells.to_numpy())
    return {name: spikes.get_group(name).to_numpy() for name in sorted(cells.unique(), key=_in_order)}


def _in_order(name: str) -> tuple[bool, float, str]:
    """Sort numbers by their value, before words."""
    return (False, float(name), name) if name.isdecimal() else (True, 0.0, name)
