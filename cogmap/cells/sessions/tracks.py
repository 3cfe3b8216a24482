"""Tracks in memory, however they are kept: tables, arrays, a recording, series of pynapple or neo."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from cogmap.cells.sessions.neo_objects import is_neo_signal, neo_series
from cogmap.cells.sessions.pynapple_objects import is_pynapple, pynapple_series
from cogmap.cells.sessions.recorded import Series, Track, track_of
from cogmap.cells.sessions.samples import headings_at
from cogmap.cells.sessions.units import in_radians
from cogmap.errors import CogmapError

ASKED = (
    "give a file, a table with t, x, y and, optionally, heading or heading_deg, a pair of times and "
    "positions or three with headings, or series of pynapple or neo"
)


def as_track(track: Any, *, heading_unit: str | None = None) -> Track:
    """Give times, positions and headings of an animal.

    Parameters
    ----------
    track
        A table with `t` (s), `x`, `y` and, optionally, `heading` or `heading_deg`; times (s), positions
        (samples, 2) and, optionally, headings in a tuple; a series of positions of pynapple or neo, or a
        tuple of one and a series of headings, at times of their own; whatever has `times` and `positions` or
        `poses`, as a recording, a session or what `arena.read_track` gives.
    heading_unit
        "rad" or "deg", of series.

    Raises
    ------
    CogmapError
        For anything else.
    """
    if track is None:
        raise CogmapError(f"the session has no track, so nobody knows where the spikes were; {ASKED}")
    if isinstance(track, pd.DataFrame):
        return _table(track)
    found = _of_attributes(track)
    if found is not None:
        return found
    parts = track if isinstance(track, tuple | list) else [track]
    if parts and _is_series(parts[0]) and len(parts) < 3:
        return of_series(*(_series(part) for part in parts), heading_unit=heading_unit)
    if len(parts) not in {2, 3}:
        raise CogmapError(f"a track cannot be made of {type(track).__name__}; {ASKED}")
    return track_of(*parts)


def of_series(positions: Series, headings: Series | None = None, *, heading_unit: str | None = None) -> Track:
    """Join positions and headings, which may have been sampled at other times.

    Raises
    ------
    CogmapError
        For positions of more than two axes, headings of more than one, units that cannot be.
    """
    places = positions.data.reshape(len(positions.times), -1)
    if places.shape[1] == 1:
        # Along a track that has been straightened.
        places = np.concatenate([places, np.zeros_like(places)], axis=1)
    if places.shape[1] != 2:
        raise CogmapError(f"positions have {places.shape[1]} columns; give x and y alone")
    if headings is None:
        return track_of(positions.times, places, unit=positions.unit)
    turns = headings.data.reshape(len(headings.times), -1)
    if turns.shape[1] != 1:
        raise CogmapError(f"headings have {turns.shape[1]} columns; give one angle")
    radians = in_radians(turns[:, 0], headings.unit, heading_unit)
    ahead = headings_at(Series(headings.times, radians, None), positions.times)
    return track_of(positions.times, places, ahead, unit=positions.unit, heading_unit="rad")


def _of_attributes(track: Any) -> Track | None:
    """Read what has times, and positions or poses."""
    poses = getattr(track, "poses", None)
    if poses is not None:
        return track_of(track.times, np.asarray(poses)[:, :2], np.asarray(poses)[:, 2])
    if hasattr(track, "times") and hasattr(track, "positions"):
        found = track_of(track.times, track.positions, getattr(track, "headings", None))
        return replace(found, notes=getattr(track, "notes", {}))
    return None


def _table(table: pd.DataFrame) -> Track:
    missing = {"t", "x", "y"} - set(table.columns)
    if missing:
        raise CogmapError(f"the track has no column {' and no '.join(sorted(missing))}; {ASKED}")
    names = [name for name in ("heading", "heading_deg") if name in table.columns]
    if len(names) > 1:
        raise CogmapError("the track has both heading and heading_deg; leave one of them out")
    times, *axes = (table[name].to_numpy(dtype=float) for name in ("t", "x", "y", *names))
    unit = "deg" if names == ["heading_deg"] else None
    return track_of(times, np.stack(axes[:2], axis=1), axes[2] if names else None, heading_unit=unit)


def _is_series(value: Any) -> bool:
    return is_pynapple(value) or is_neo_signal(value)


def _series(value: Any) -> Series:
    if is_pynapple(value):
        return pynapple_series(value)
    if is_neo_signal(value):
        return neo_series(value)
    raise CogmapError(f"headings are {type(value).__name__}; give a series as that of the positions")
