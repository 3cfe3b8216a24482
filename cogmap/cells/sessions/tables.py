"""Files of plain tables: a track, and the spikes beside it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from arena.motions.paths import read_path
from cogmap.cells.sessions.recorded import Track, track_of
from cogmap.errors import CogmapError

SPIKES, TRACK = "spikes.csv", "track.csv"
"""In the folder of a session."""


def read_track_file(path: Path, **options: Any) -> Track:
    """Read where the animal was: `t` (s), `x`, `y` and, optionally, `heading` (rad) or `heading_deg`.

    Raises
    ------
    ArenaError
        When it cannot be read.
    CogmapError
        For options, of which there are none.
    """
    if options:
        raise CogmapError(f"unknown option {next(iter(options))!r} for a track")
    found = read_path(path)
    return track_of(found.times, found.positions, found.headings)


def read_spikes(path: Path) -> dict[str, Float[np.ndarray, "_"]]:
    """Read spike times (s) by cell from a CSV file with the columns `cell` and `t`, one row a spike.

    Raises
    ------
    CogmapError
        When it cannot be read, lacks a column, or holds a time that is no number.
    """
    try:
        table = pd.read_csv(path, encoding="utf-8-sig", skipinitialspace=True, dtype={"cell": str})
    except OSError as error:
        raise CogmapError(f"cannot read the spikes {path}: {error.strerror or error}") from None
    except ValueError as error:
        raise CogmapError(f"{path} is no table of spikes: {' '.join(str(error).split())}") from None
    return sort_spikes(table.rename(columns=lambda name: str(name).strip()), str(path))


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
    wrong = np.flatnonzero(~np.isfinite(times) | table["cell"].isna().to_numpy())
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
