"""Tracks of animals: a tracker's table in; times, positions and headings out, and what was judged of them."""

import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from arena.errors import ArenaError, TrackWarning
from arena.paths import user_path
from arena.recordings.columns import listed, names_of, read_columns
from arena.recordings.delimited import Rows
from arena.recordings.judged import lost_as
from arena.recordings.lost_samples import equal_to, jumps, sentinel, too_fast
from arena.recordings.track_columns import TrackColumns, choose_columns
from arena.recordings.track_format import TrackFormat
from arena.recordings.track_units import check_seconds, to_metres, to_radians

Times = Float[np.ndarray, " samples"]
Positions = Float[np.ndarray, "samples 2"]


class RecordedPath(NamedTuple):
    """Where an animal was, as recorded: NaN where the tracker lost it, or its head."""

    times: Times
    """s, increasing."""
    positions: Positions
    """m, with the options told; else the file's units are taken for metres."""
    headings: Float[np.ndarray, " samples"] | None
    """rad, wrapped or not."""
    notes: Mapping[str, object]
    """What was judged, for options that were given and faults that were found, as far as JSON can say:
    samples that are `blank`, `missing`, `unlikely`, `too_fast` (each once, lost), and `doubtful` (kept);
    `metres_per_unit` along x and y, `y_down` and `rate`."""
    doubtful: Bool[np.ndarray, " samples"]
    """Samples that jump off and back (`arena.recordings.lost_samples.jumps`): kept, and warned of."""


def read_track(path: str | Path, **options: Any) -> RecordedPath:
    """Read an animal's track: `read_track("rat.csv", bodypart="nose", rate=30, scale=0.002, y_down=True)`.

    Tables are text (`.csv`, `.tsv`, `.txt`), Parquet or NPZ. Text has a line of names, or the three of
    DeepLabCut, and is parted by commas, semicolons or tabs; decimals have points or commas; UTF-8 or UTF-16.
    Without options there must be columns `t` (s), `x`, `y` (m) and there may be `heading` (rad) or
    `heading_deg`; other columns are left alone. An NPZ file holds arrays of the same names, or `pos`,
    (samples, 2), for x and y.

    What `missing` and `fastest` leave is looked through for jumps off and back, and for a pair of numbers
    that recurs there. They are kept, for nobody said that they are lost, and a `TrackWarning` tells of them.

    Parameters
    ----------
    path
        The file; its ending may be capitals.
    options
        Which columns are what, units, and what is lost: see `arena.recordings.track_format.TrackFormat`.

    Raises
    ------
    ArenaError
        For unknown options; when the file cannot be read, lacks a column (the error lists those found), holds
        something that is not a number, has fewer than two positions, or times that do not increase; for times
        that count frames, radians that are degrees, and the reverse.
    """
    return read_as(user_path(path), TrackFormat(**options))


def read_as(path: Path, told: TrackFormat, *, warn: bool = True) -> RecordedPath:
    """Read a track by its format; see `read_track`. Who judges doubtful samples need no warning of them."""
    found = choose_columns(path, names_of(path), told)
    columns, rows = _rows_of_track(path, found, told)
    positions = np.stack([columns[found.x], columns[found.y]], axis=1)
    times = _times(path, found, told, columns, rows)
    for name in (found.x, found.y, *([found.heading] if found.heading else [])):
        check_finite(path, name, columns[name], rows)
    notes: dict[str, object] = {}
    lost = _lost(found, told, columns, positions, notes)
    positions[lost] = np.nan
    if told.rate is None and found.t is not None:
        check_seconds(path, found.t, times, positions)
    headings = None
    if found.heading is not None:
        headings = _radians(path, found.heading, np.where(lost, np.nan, columns[found.heading]), times, told)
    metres = told.metres_per_unit
    placed, headings = to_metres(positions, headings, metres, y_down=told.y_down)
    if told.fastest is not None:
        fast = too_fast(times, placed, told.fastest)
        placed[fast], positions[fast] = np.nan, np.nan
        if headings is not None:
            headings[fast] = np.nan
        notes["too_fast"] = int(fast.sum())
    _check_known(path, placed, headings, notes)
    doubtful = jumps(times, positions)
    if doubtful.any():
        notes["doubtful"] = int(doubtful.sum())
        if warn:
            warnings.warn(_doubt(path, positions, doubtful), TrackWarning, stacklevel=3)
    units = {"metres_per_unit": list(metres), "y_down": told.y_down, "rate": told.rate}
    usual = {"metres_per_unit": [1.0, 1.0], "y_down": False, "rate": None}
    notes |= {name: value for name, value in units.items() if value != usual[name]}
    return RecordedPath(times, placed, headings, notes, doubtful)


def check_finite(
    path: Path, name: str, values: Float[np.ndarray, " samples"], rows: Rows, *, whole: bool = False
) -> None:
    """Raise for infinite values, and for missing ones where all must be there.

    Raises
    ------
    ArenaError
        With the row of the file.
    """
    wrong = ~np.isfinite(values) if whole else np.isinf(values)
    if wrong.any():
        first = np.flatnonzero(wrong)[0]
        raise ArenaError(f"{path}: row {rows[first]} has {name} = {values[first]}; give a finite number")


def check_increasing(path: Path, name: str, times: Times, rows: Rows) -> None:
    """Raise for times that are missing, infinite or do not increase.

    Raises
    ------
    ArenaError
        With the row of the file.
    """
    check_finite(path, name, times, rows, whole=True)
    late = np.flatnonzero(np.diff(times) <= 0)
    if len(late):
        before, after = times[late[0] : late[0] + 2]
        raise ArenaError(
            f"{path}: the times do not increase at row {rows[late[0] + 1]}, where {after:g} s follows "
            f"{before:g} s; sort the rows and keep one a time"
        )


def _rows_of_track(path: Path, found: TrackColumns, told: TrackFormat) -> tuple[dict[str, np.ndarray], Rows]:
    """Read the columns, and keep the rows of the track that is told."""
    words = [found.track] if found.track else []
    columns, rows = read_columns(path, found.all, words)
    if not found.track:
        return columns, rows
    tracks = columns.pop(found.track)
    there = list(dict.fromkeys(tracks.tolist()))
    if told.individual is None and len(there) > 1:
        raise ArenaError(f"{path} has several tracks, {listed(there)}; choose one: individual={there[0]!r}")
    if told.individual is not None and told.individual not in there:
        raise ArenaError(f"{path} has no track {told.individual!r}; it has {listed(there)}")
    mine = tracks == (told.individual if told.individual is not None else tracks)
    return {name: values[mine] for name, values in columns.items()}, rows[mine]


def _times(
    path: Path, found: TrackColumns, told: TrackFormat, columns: Mapping[str, np.ndarray], rows: Rows
) -> Times:
    if told.rate is None:
        times = columns[str(found.t)]
        check_increasing(path, str(found.t), times, rows)
        return times
    if found.t is None:
        return np.arange(len(rows)) / told.rate
    counted = columns[found.t]
    if told.t is None and (counted % 1 != 0).any() and np.isfinite(counted).all():
        raise ArenaError(
            f"{path}: {found.t} has fractions, such as {counted[counted % 1 != 0][0]:g}, and counts no "
            f"frames; leave rate out if it is in s, or pass t={found.t!r} if rate= says how many of its "
            "units make a second"
        )
    check_increasing(path, found.t, counted, rows)
    return counted / told.rate


def _lost(
    found: TrackColumns,
    told: TrackFormat,
    columns: Mapping[str, np.ndarray],
    positions: Positions,
    notes: dict[str, object],
) -> Bool[np.ndarray, " samples"]:
    """Find the samples that are lost by what the tracker wrote, and note how many of each kind."""
    blank = np.isnan(positions).any(axis=1)
    if blank.any():
        notes["blank"] = int(blank.sum())
    lost = np.zeros(len(positions), dtype=bool)
    if told.missing:
        lost = equal_to(positions, told.missing)
        notes["missing"] = int(lost.sum())
    if found.likelihood is not None and told.least_likelihood is not None:
        # What has no likelihood has none that suffices.
        unlikely = ~(columns[found.likelihood] >= told.least_likelihood) & ~lost & ~blank
        notes["unlikely"] = int(unlikely.sum())
        lost |= unlikely
    return lost


def _radians(
    path: Path, name: str, headings: Float[np.ndarray, " samples"], times: Times, told: TrackFormat
) -> Float[np.ndarray, " samples"]:
    """Give headings in rad; told numbers that are no angles are missing there, too."""
    degrees = told.heading_in == "deg" if told.heading_in else name.lower().endswith("deg")
    most = 360.0 if degrees else 2 * np.pi
    none = [value for value in told.missing if np.ndim(value) == 0 and np.abs(value) > most]
    headings = np.where(np.isin(headings, none), np.nan, headings)
    return to_radians(path, name, headings, times, degrees=degrees)


def _check_known(
    path: Path,
    positions: Positions,
    headings: Float[np.ndarray, " samples"] | None,
    notes: Mapping[str, object],
) -> None:
    known = np.isfinite(positions).all(axis=1)
    if known.sum() < 2:
        lost = lost_as(notes)
        raise ArenaError(
            f"{path} has {known.sum()} positions that are numbers{lost and f' ({lost})'}; "
            "a path needs at least two"
        )
    if headings is not None and not np.isfinite(headings).any():
        raise ArenaError(f"{path} has a heading column without a number; leave it out")


def _doubt(path: Path, positions: Positions, doubtful: Bool[np.ndarray, " samples"]) -> str:
    """Say in a sentence which samples are doubtful, and what to pass."""
    usual = sentinel(positions, doubtful)
    count = int(doubtful.sum())
    if usual is None:
        return (
            f"{path}: {count} of {len(positions)} samples jump off and back, far faster than the path "
            "usually is; pass fastest=, in m/s, if the tracker erred there"
        )
    pair = f"{usual.x:g}" if usual.x == usual.y else f"(({usual.x:g}, {usual.y:g}),)"
    rest = f", and {count - usual.samples} more jump, too" if count > usual.samples else ""
    return (
        f"{path}: {usual.samples} of {len(positions)} samples are exactly ({usual.x:g}, {usual.y:g}), where "
        f"the path jumps to and back{rest}: trackers write such a pair where they lost the animal; "
        f"pass missing={pair} if so"
    )
