"""What stands beside pictures: times, poses and signals, of which each picture gets its row."""

import re
from collections.abc import Collection
from typing import Any, NamedTuple, SupportsFloat

import numpy as np
from jaxtyping import Float32, Float64

from arena.angles import wrap_angle
from arena.errors import ArenaError
from arena.recordings.tables import Table, table_of, times_of

POSE = ("x", "y", "heading")
"""Columns of poses: m, m, rad; `heading_deg` may stand in for the last."""

Row = Float64[np.ndarray, " views"]


class Beside(NamedTuple):
    """Tables beside pictures, read but not yet matched to them."""

    times: Float64[np.ndarray, " views"] | None
    rate: float | None
    poses: Table | None
    signals: Table | None
    log: bool

    @classmethod
    def read(
        cls,
        *,
        times: Any,
        rate: SupportsFloat | None,
        poses: Any,
        signals: Any,
        columns: Collection[str] | None,
        log: bool,
    ) -> "Beside":
        """Read what `arena.Recording.from_images` is given beside pictures.

        Raises
        ------
        ArenaError
            When something cannot be read or does not go together.
        """
        if times is not None and rate is not None:
            raise ArenaError("both times and rate are given; choose one")
        every = None if rate is None else float(rate)
        if every is not None and not 0 < every < np.inf:
            raise ArenaError(f"the rate is {every:g}; give pictures a second, more than 0")
        if signals is None and (log or columns is not None):
            raise ArenaError(
                "log and columns are of signals, and none are given; give signals or leave them out"
            )
        return cls(
            None if times is None else times_of(times),
            every,
            None if poses is None else table_of(poses, "poses", (*POSE, "heading_deg"), names=POSE),
            None if signals is None else table_of(signals, "signals", columns, needed=columns or ()),
            bool(log),
        )

    def matched(self, count: int, rate: float | None) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """Give the arrays of a recording of so many pictures, and what there is to tell of them.

        Parameters
        ----------
        count, rate
            Pictures, and how many of them a second a video itself says it shows.

        Raises
        ------
        ArenaError
            When rows and pictures cannot be matched, or values are none that a recording can have.
        """
        clock, known_by = self._clock(count, rate)
        columns: dict[str, np.ndarray] = {"times": np.arange(count, dtype=float) if clock is None else clock}
        notes: dict[str, Any] = {"times": known_by, "log": self.log}
        if self.signals is not None:
            names = _names(self.signals)
            raw = {names[name]: _rows(self.signals, name, clock, count) for name in names}
            columns["odours"] = _odours(self.signals.label, raw, log=self.log)
            columns |= {f"signals/{name}": values for name, values in raw.items()}
            notes["signals"] = {new: old for old, new in names.items()}
        if self.poses is not None:
            columns["poses"] = _poses(self.poses, clock, count)
        return columns, notes

    def _clock(self, count: int, rate: float | None) -> tuple[Row | None, str]:
        """Give the times of the pictures, None when nobody tells, and who told."""
        if self.times is not None:
            if len(self.times) != count:
                raise ArenaError(
                    f"there are {len(self.times)} times for {count} pictures; give one a picture"
                )
            return self.times, "given"
        if self.rate is not None:
            return np.arange(count) / self.rate, "rate"
        if rate is not None:
            return np.arange(count) / rate, "video"
        for name, table in {"signals": self.signals, "poses": self.poses}.items():
            if table is not None and table.times is not None and table.rows == count:
                return table.times, name
        return None, "one a second, as nothing tells"


def _names(table: Table) -> dict[str, str]:
    """Make words of the names of columns."""
    if not table.columns:
        raise ArenaError(f"{table.label} has no column but times; give it one a signal")
    words = {name: re.sub(r"\W+", "_", name).strip("_") for name in table.columns}
    names = {name: word if word.isidentifier() else f"_{word}" for name, word in words.items()}
    twice = [name for name in names if list(names.values()).count(names[name]) > 1]
    if twice:
        raise ArenaError(
            f"{table.label}: {' and '.join(twice)} are both {names[twice[0]]} as a word; rename one"
        )
    return names


def _rows(table: Table, name: str, clock: Row | None, count: int, *, angle: bool = False) -> Row:
    """Give a column's value at every picture: its own row's, or by times on the line between its neighbours.

    Of an angle (rad) that is the shorter way round.
    """
    values, label = table.columns[name], f"{table.label}: {name}"
    if np.isinf(values).any():
        raise ArenaError(f"{label} is infinite in {int(np.isinf(values).sum())} rows; leave them empty")
    known = np.isfinite(values)
    by_time = table.times is not None and clock is not None
    if not by_time and table.rows != count:
        raise ArenaError(
            f"{table.label} has {table.rows} rows for {count} pictures; give one a picture, or a column t (s)"
            " there and times or rate of the pictures"
        )
    if known.all() and not by_time:
        return values
    of_rows = clock if table.times is None else table.times
    if of_rows is None or not known.any():
        raise ArenaError(
            f"{label} is missing in {int((~known).sum())} of {len(values)} rows; fill them, or give times to "
            "interpolate over"
        )
    wanted = of_rows if clock is None else clock
    times = of_rows[known]
    # A slow signal is not asked to go on to the last picture: its last value lasts as long as others do.
    lasts = float(np.median(np.diff(of_rows))) if len(of_rows) > 1 else 0.0
    outside = (wanted < times[0] - lasts * 1.001) | (wanted > times[-1] + lasts * 1.001)
    if outside.any():
        raise ArenaError(
            f"{label} is known from {times[0]:g} to {times[-1]:g} s, and {int(outside.sum())} of {count} "
            f"pictures, which go from {wanted[0]:g} to {wanted[-1]:g} s, are taken outside; give both the "
            "same clock, or leave those pictures out"
        )
    found: np.ndarray = np.interp(wanted, times, np.unwrap(values[known]) if angle else values[known])
    return found


def _odours(label: str, signals: dict[str, Row], *, log: bool) -> Float32[np.ndarray, "views odorants"]:
    """Make concentrations of signals."""
    values = np.column_stack(list(signals.values()))
    with np.errstate(over="ignore", under="ignore"):
        odours = (10.0 ** (values / 10) if log else values).astype(np.float32)
    wrong = np.argwhere(~((odours > 0) & np.isfinite(odours)))
    if len(wrong):
        row, column = wrong[0]
        found = f"{label}: {list(signals)[column]} is {values[row, column]:g} at picture {row}"
        if log:
            raise ArenaError(
                f"{found}, and 10^(value / 10) is no concentration; are these decibels? leave log out"
            )
        raise ArenaError(
            f"{found}; concentrations are more than 0: say log (--log) if these are decibels, or shift them"
        )
    return odours


def _poses(table: Table, clock: Row | None, count: int) -> Float64[np.ndarray, "views 3"]:
    """Give x, y (m) and heading (rad) of every picture."""
    columns = dict(table.columns)
    if {"heading", "heading_deg"} <= columns.keys():
        raise ArenaError(f"{table.label} has both heading and heading_deg; leave one of them out")
    if "heading_deg" in columns:
        columns["heading"] = np.deg2rad(columns["heading_deg"])
    elif "heading" in columns:
        most = np.abs(columns["heading"][np.isfinite(columns["heading"])]).max(initial=0)
        if most > 2 * np.pi + 1e-6:
            raise ArenaError(
                f"{table.label}: heading goes to {most:g}, which is more than a turn; call the column "
                "heading_deg if these are degrees, or wrap it into (−π, π]"
            )
    lacking = [name for name in POSE if name not in columns]
    if lacking:
        raise ArenaError(
            f"{table.label} has no column {' and no '.join(lacking)}; it must have x, y (m) and heading "
            "(rad) or heading_deg"
        )
    whole = table._replace(columns=columns)
    x, y = (_rows(whole, name, clock, count) for name in ("x", "y"))
    return np.column_stack([x, y, wrap_angle(_rows(whole, "heading", clock, count, angle=True))])
