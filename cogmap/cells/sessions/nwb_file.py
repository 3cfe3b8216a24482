"""NWB files: position, compass direction, units, and rates where a model has left them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from cogmap.atomic import user_path
from cogmap.cells.sessions.pynapple_objects import CELL_TYPE
from cogmap.cells.sessions.recorded import ONE_POPULATION, Recorded, Series, Track
from cogmap.cells.sessions.tracks import of_series
from cogmap.cells.sessions.units import scaled
from cogmap.errors import CogmapError

ENDINGS = (".nwb", ".h5", ".hdf5")
_SPIKES, _RATES = "spikes", "rates"
# What h5py, hdmf and pynwb have been seen to raise on files that are cut short, damaged or of another kind.
_DAMAGE = (OSError, ValueError, LookupError, TypeError, AttributeError, RuntimeError)


def is_nwb(source: object) -> bool:
    """Whether it is the path of an NWB file, one that pynwb has opened, or pynapple's view of one."""
    if isinstance(source, str | Path):
        return Path(source).suffix.lower() in ENDINGS
    return _is_nwb_file(source) or _is_nwb_file(getattr(source, "nwb", None))


def read_nwb(
    source: Any,
    *,
    track: Track | None = None,
    position: str | None = None,
    heading: str | None = None,
    heading_unit: str | None = None,
    activity: str | None = None,
) -> Recorded:
    """Read cells and track of an NWB file; `conversion`, `offset` and `unit` of each series are honoured.

    Parameters
    ----------
    source
        A path, or a file that is open.
    track
        From elsewhere, in place of the file's.
    position, heading
        Names of series, or of their container and them, as `Position/led`; needed where there are several
        that can be meant. The heading may be any series, else it is that in a `CompassDirection`.
    heading_unit
        "rad" or "deg" where the file is wrong about it.
    activity
        "spikes" of the units, "rates" of series in hertz that have the times of the position; spikes where
        there are units when None.

    Raises
    ------
    CogmapError
        When pynwb is missing, the file cannot be read, lacks what is needed, or has more than one of it.
    """
    with _opened(source) as file:
        if track is None:
            track = _track(file, position, heading, heading_unit)
        if activity is None:
            activity = _RATES if file.units is None else _SPIKES
        recorded = _units(file, track) if activity == _SPIKES else _rates(file, track)
    return replace(recorded, notes={"activity": activity})


def _is_nwb_file(value: object) -> bool:
    return type(value).__name__ == "NWBFile" and type(value).__module__.startswith("pynwb")


@contextmanager
def _opened(source: Any) -> Iterator[Any]:
    """Give the file open, and say in one sentence what is wrong with it."""
    if not isinstance(source, str | Path):
        yield source if _is_nwb_file(source) else source.nwb
        return
    try:
        import pynwb  # noqa: PLC0415
    except ImportError:
        raise CogmapError(
            "reading NWB needs pynwb, which is not installed; run `pip install 'cogmap[nwb]'`"
        ) from None
    from hdmf.build.errors import BuildError, ConstructError  # noqa: PLC0415

    path = user_path(source)
    if not path.is_file():
        raise CogmapError(f"cannot read {path}: there is no such file")
    try:
        with pynwb.NWBHDF5IO(path, "r") as disk:
            yield disk.read()
    except CogmapError:
        raise
    except (*_DAMAGE, BuildError, ConstructError) as error:
        told = (str(error).splitlines() or [type(error).__name__])[0]
        raise CogmapError(f"{path} cannot be read as NWB: {told}; it is damaged or of another kind") from None


def _of_kind(file: Any, kind: str) -> list[Any]:
    """Find all objects of a class by its name, in the order of their paths."""
    found = [item for item in file.objects.values() if kind in {base.__name__ for base in type(item).__mro__}]
    return sorted(found, key=_name)


def _name(series: Any) -> str:
    return f"{series.parent.name}/{series.name}" if series.parent is not None else str(series.name)


def _chosen(found: list[Any], name: str | None, what: str) -> Any:
    """Take the only series that can be meant."""
    if name is not None:
        found = [item for item in found if name in {item.name, _name(item)}]
    names = ", ".join(map(_name, found))
    if len(found) > 1:
        raise CogmapError(f"there is more than one {what}: {names}; say which, as {what}={_name(found[0])!r}")
    return found[0] if found else None


def _track(file: Any, position: str | None, heading: str | None, heading_unit: str | None) -> Track:
    """Read where the animal was and faced, and note by which series."""
    where, ahead = _position(file, position), _heading(file, heading)
    track = of_series(_series(where), None if ahead is None else _series(ahead), heading_unit=heading_unit)
    notes = {"position": _name(where), **({} if ahead is None else {"heading": _name(ahead)})}
    return replace(track, notes=notes)


def _position(file: Any, name: str | None) -> Any:
    series = _of_kind(file, "SpatialSeries")
    if name is None:
        series = [item for item in series if type(item.parent).__name__ == "Position"] or [
            item for item in series if np.ndim(item.data) == 2 and np.shape(item.data)[1] == 2
        ]
    found = _chosen(series, name, "position")
    if found is None:
        known = ", ".join(map(_name, _of_kind(file, "SpatialSeries"))) or "no spatial series at all"
        told = "" if name is None else f" {name!r}"
        raise CogmapError(
            f"the file has no position{told}; it has {known}: say which it is, as position='NAME', or give "
            "the track= from elsewhere"
        )
    return found


def _heading(file: Any, name: str | None) -> Any:
    if name is None:
        compass = [
            s for s in _of_kind(file, "SpatialSeries") if type(s.parent).__name__ == "CompassDirection"
        ]
        return _chosen(compass, None, "heading")
    found = _chosen(_of_kind(file, "TimeSeries"), name, "heading")
    if found is None:
        known = ", ".join(map(_name, _of_kind(file, "TimeSeries")))
        raise CogmapError(f"the file has no series {name!r} to be the heading; it has {known}")
    return found


def _series(series: Any) -> Series:
    values = scaled(np.asarray(series.data[:], dtype=float), series.conversion) + series.offset
    return Series(np.asarray(series.get_timestamps()[:], dtype=float), values, series.unit)


def _units(file: Any, track: Track) -> Recorded:
    units = file.units
    if units is None or not len(units) or "spike_times" not in units.colnames:
        raise CogmapError("the file has no units with spike times; give one in which spikes are sorted")
    trains = [
        np.sort(np.asarray(units.get_unit_spike_times(index), dtype=float)) for index in range(len(units))
    ]
    names = next((units[name][:] for name in ("unit_name", "label") if name in units.colnames), units.id[:])
    if len({*map(str, names)}) < len(trains):
        names = units.id[:]
    kinds = units[CELL_TYPE][:] if CELL_TYPE in units.colnames else [ONE_POPULATION] * len(trains)
    return Recorded(
        track, [str(name) for name in names], [str(kind) for kind in kinds], trains, observed=_observed(units)
    )


def _observed(units: Any) -> Float[np.ndarray, "epochs 2"] | None:
    """Intersect the intervals in which the units were listened to."""
    if "obs_intervals" not in units.colnames:
        return None
    common = np.array([[-np.inf, np.inf]])
    for index in range(len(units)):
        mine = np.reshape(np.asarray(units.get_unit_obs_intervals(index), dtype=float), (-1, 2))
        starts = np.maximum(common[:, None, 0], mine[None, :, 0]).ravel()
        stops = np.minimum(common[:, None, 1], mine[None, :, 1]).ravel()
        common = np.stack([starts, stops], axis=1)[starts < stops]
    return common


def _rates(file: Any, track: Track) -> Recorded:
    found = [
        series
        for series in _of_kind(file, "TimeSeries")
        if str(series.unit).lower() in {"hertz", "hz"} and np.ndim(series.data) == 2
    ]
    fit = [
        series
        for series in found
        if len(series.data) == len(track.times) and np.array_equal(series.get_timestamps()[:], track.times)
    ]
    if not fit:
        told = ", ".join(map(_name, found)) or "none at all"
        raise CogmapError(
            f"the file has no rates in hertz at the times of the position; it has {told}: read its spikes"
        )
    order = _populations(file.units)
    fit.sort(key=lambda series: order.index(_kind(series)) if _kind(series) in order else len(order))
    rates = np.concatenate([np.asarray(series.data[:], dtype=float) for series in fit], axis=1)
    kinds = [_kind(series) for series in fit for _ in range(series.data.shape[1])]
    return Recorded(track, [str(index) for index in range(len(kinds))], kinds, rates=rates)


def _kind(series: Any) -> str:
    """Name the population whose rates a series has."""
    return str(series.name).removesuffix("_rates")


def _populations(units: Any) -> list[str]:
    """Give the populations of the units in their order, by which those of rates are ordered too."""
    sorted_into = units is not None and CELL_TYPE in units.colnames
    return list(dict.fromkeys(map(str, units[CELL_TYPE][:]))) if sorted_into else []
