"""A session: an animal's cells, sample by sample, with where it was and faced; and how one is made."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int

from cogmap.atomic import user_path
from cogmap.cells.sessions.nwb_file import is_nwb, read_nwb
from cogmap.cells.sessions.recorded import Recorded, Track
from cogmap.cells.sessions.samples import count_spikes, sample_durations, speeds, within
from cogmap.cells.sessions.tables import SPIKES, TRACK, read_track_file
from cogmap.cells.sessions.tracks import as_track
from cogmap.cells.sessions.trains import as_trains
from cogmap.cells.sessions.units import check_metres, in_radians, metres_per, positive, scaled
from cogmap.errors import CogmapError
from cogmap.inputs import check_choice


@dataclass(frozen=True, eq=False, kw_only=True)
class Session:
    """What cells did while an animal walked: a row of every array is a sample of its track, a view."""

    times: Float[np.ndarray, "views"]
    """s, increasing; where samples are left out there are gaps."""
    positions: Float[np.ndarray, "views 2"]
    """m."""
    headings: Float[np.ndarray, "views"] | None
    """rad, in (−π, π]; None when nobody knows them."""
    rates: Float[np.ndarray, "views cells"]
    """Hz."""
    counts: Int[np.ndarray, "views cells"] | None
    """Spikes; None when only rates are known."""
    names: tuple[str, ...]
    """Of the cells."""
    populations: tuple[str, ...]
    """Of each cell."""
    seconds: float
    """How long a sample usually lasts."""
    notes: Mapping[str, Any] = field(default_factory=dict)
    """How it was read, and what was left out."""

    def __len__(self) -> int:
        return len(self.times)

    def population(self, name: str) -> Session:
        """Give the cells of one population alone.

        Raises
        ------
        CogmapError
            When there is none of this name.
        """
        mine = np.array([kind == name for kind in self.populations])
        if not mine.any():
            known = ", ".join(dict.fromkeys(self.populations))
            raise CogmapError(f"there is no population {name!r}; choose one of {known}")
        return replace(
            self,
            rates=self.rates[:, mine],
            counts=None if self.counts is None else self.counts[:, mine],
            names=tuple(np.array(self.names, dtype=object)[mine]),
            populations=(name,) * int(mine.sum()),
        )


def session(
    source: Any,
    *,
    track: Any = None,
    position: str | None = None,
    heading: str | None = None,
    activity: str | None = None,
    unit: str | None = None,
    metres_per_unit: object = None,
    heading_unit: str | None = None,
    slowest: object = 0.0,
    between: Sequence[Any] | None = None,
    **reading: Any,
) -> Session:
    """Read an animal's spikes and track as samples: rates in Hz, positions in m, headings in rad.

    A sample lasts until the next, or twice what is usual where this is shorter; its rate is the number of
    spikes in it over how long it lasts. Samples are left out where the tracker lost the animal or its head,
    where not all cells were observed, and where it was too slow. `notes` count them, and spikes in none.

    Parameters
    ----------
    source
        An NWB file (its path, or open), which has its own track; or spikes, with a `track`: a folder with
        `spikes.csv` (columns `cell`, `t` in s) and `track.csv`, the path of such a table or the table itself,
        a pynapple `TsGroup`, a neo `Segment`, `Block` or list of `SpikeTrain`, spike times in s by cell in a
        mapping or a list.
    track
        Where the animal was: the path of a file, or as `cogmap.cells.sessions.tracks.as_track` takes it, a
        table, times and positions (and headings) in a tuple, series of pynapple or neo, a recording.
    position, heading
        Names of the series in an NWB file, where there are several; `heading` is also the name of a column
        of a track's file.
    activity
        "spikes" or "rates" of an NWB file; its spikes when None and there are any.
    unit
        Of the positions: "m", "cm", "mm", "in", ...; what the source says when None, else metres. What is
        said here goes before what the source says.
    metres_per_unit
        In place of a unit, as for pixels.
    heading_unit
        "rad" or "deg" in place of what the source says.
    slowest
        m/s; samples below are left out. Usual are 0.02 to 0.05: at rest place cells replay other places.
    between
        From when to when, s; all when None.
    reading
        Options for a track's file, as `arena.read_track` takes them: `x="nose_x"`, `rate=30`, `missing=0`.

    Raises
    ------
    CogmapError, ArenaError
        For what cannot be read, positions that look not to be metres, headings that look not to be radians,
        times that do not increase, and when no sample is left.
    """
    if activity is not None:
        check_choice("activity", activity, ("spikes", "rates"))
    if not is_nwb(source) and isinstance(source, str | Path) and user_path(source).is_dir():
        track = user_path(source) / TRACK if track is None else track
        source = user_path(source) / SPIKES
    in_file = isinstance(track, str | Path)
    if in_file and heading is not None and not is_nwb(source):
        reading, heading = {**reading, "heading": heading}, None
    units: dict[str, Any] = {"unit": unit, "metres_per_unit": metres_per_unit, "heading_unit": heading_unit}
    chosen = {"position": position, "heading": heading, "activity": activity}
    if is_nwb(source):
        where = None if track is None else _track(track, units, reading)
        if where is None and reading:
            raise CogmapError(f"unknown option {next(iter(reading))!r}")
        recorded = read_nwb(source, track=where, heading_unit=heading_unit, **chosen)
    else:
        wrong = [name for name, value in chosen.items() if value is not None]
        if wrong:
            raise CogmapError(f"{wrong[0]} chooses a series of an NWB file; leave it out")
        trains, kinds = as_trains(source)
        where = _track(track, units, reading)
        recorded = Recorded(where, list(trains), kinds, list(trains.values()))
    if in_file:
        # A file is read as metres and radians by its units.
        check_metres(recorded.track.positions, told=unit == "m")
        placed = recorded.track
    else:
        placed = _placed(recorded.track, unit, metres_per_unit, heading_unit)
    return sampled(replace(recorded, track=placed), slowest=slowest, between=between)


def _track(track: Any, units: Mapping[str, Any], reading: Mapping[str, Any]) -> Track:
    """Read a track, of a file in metres and radians by its units."""
    if isinstance(track, str | Path):
        return read_track_file(user_path(track), **units, **reading)
    if track is not None and reading:
        raise CogmapError(
            f"the option {next(iter(reading))} is for a track's file, and it is none; leave it out"
        )
    return as_track(track, heading_unit=units["heading_unit"])


def _placed(track: Track, unit: str | None, metres_per_unit: object, heading_unit: str | None) -> Track:
    """Bring a track to metres and radians."""
    scale = metres_per(track.unit, unit, metres_per_unit)
    positions = scaled(track.positions, scale)
    check_metres(positions, told=unit == "m")
    headings = track.headings
    if headings is not None:
        # Those of series are in radians already.
        said = heading_unit if track.heading_unit is None else None
        headings = in_radians(headings, track.heading_unit, said)
    return replace(
        track, positions=positions, headings=headings, notes={**track.notes, "metres_per_unit": scale}
    )


def sampled(recorded: Recorded, *, slowest: object = 0.0, between: Sequence[Any] | None = None) -> Session:
    """Count spikes in samples, and leave out samples that tell nothing; `recorded` is in metres and radians.

    Raises
    ------
    CogmapError
        For a speed that cannot be, and when fewer than two samples are left.
    """
    least = positive("slowest", slowest, or_zero=True)
    track = recorded.track
    lasting = sample_durations(track.times)
    kept, left_out = _kept(recorded, least, between)
    told = ", ".join(f"{count} {why}" for why, count in left_out.items() if count)
    if kept.sum() < 2:
        raise CogmapError(f"{kept.sum()} of {len(kept)} samples are left ({told}); leave out fewer of them")
    notes = {**track.notes, **recorded.notes, "samples": len(kept), **left_out}
    counts, rates = None, recorded.rates
    if recorded.trains is not None:
        every, outside = count_spikes(recorded.trains, track.times, lasting)
        counts = every[kept]
        notes |= {
            "spikes": int(counts.sum()),
            "spikes_left_out": int(every.sum() - counts.sum()),
            "spikes_outside": outside,
        }
        rates = counts / lasting[kept, None]
    elif rates is not None:
        rates = rates[kept]
    return Session(
        times=track.times[kept],
        positions=track.positions[kept],
        headings=None if track.headings is None else track.headings[kept],
        rates=np.asarray(rates),
        counts=counts,
        names=tuple(recorded.names),
        populations=tuple(recorded.populations),
        seconds=float(np.median(lasting)),
        notes=notes,
    )


def _kept(
    recorded: Recorded, slowest: float, between: Sequence[Any] | None
) -> tuple[Bool[np.ndarray, "samples"], dict[str, int]]:
    """Say which samples stay, and count the others by the first reason why not."""
    track = recorded.track
    always = np.ones(len(track.times), dtype=bool)
    asked = always if between is None else within(track.times, _epoch(between))
    faced = always if track.headings is None else np.isfinite(track.headings)
    heard = always if recorded.observed is None else within(track.times, recorded.observed)
    moving = speeds(track.times, track.positions) >= slowest if slowest else always
    kept, left_out = always, dict[str, int]()
    for why, fine in (
        ("not_between", asked),
        ("lost", np.isfinite(track.positions).all(axis=1)),
        ("without_heading", faced),
        ("unobserved", heard),
        ("slow", moving),
    ):
        left_out[why] = int(np.count_nonzero(kept & ~fine))
        kept = kept & fine
    return kept, left_out


def _epoch(between: Sequence[Any]) -> Float[np.ndarray, "1 2"]:
    """Read from when to when."""
    if isinstance(between, str) or np.shape(between) != (2,) or not between[0] < between[1]:
        raise CogmapError(f"between is {between!r}; give two times in s, the earlier first")
    return np.array([between], dtype=float)
