"""Tables beside pictures: CSV, Parquet or what is in memory, as columns of numbers."""

import io
import re
import warnings
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from jaxtyping import Float64

from arena.errors import ArenaError
from arena.paths import user_path

TIMES = ("t", "time", "times", "timestamp", "timestamps", "seconds")
"""Columns of times (s), in any case."""


class Table(NamedTuple):
    """Columns of numbers, NaN where one is missing."""

    label: str
    """What errors call it."""
    times: Float64[np.ndarray, " rows"] | None
    """s, increasing."""
    columns: dict[str, Float64[np.ndarray, " rows"]]
    """All others, by their names."""

    @property
    def rows(self) -> int:
        """How many rows there are."""
        return len(next(iter(self.columns.values()))) if self.columns else 0


def table_of(
    source: Any,
    what: str,
    only: Collection[str] | None = None,
    *,
    needed: Collection[str] = (),
    names: Sequence[str] = (),
) -> Table:
    """Read a table of numbers.

    Parameters
    ----------
    source
        A Parquet file, or a CSV file with a line of names, of commas, semicolons or tabs, in UTF-8 or UTF-16
        (with its mark); with semicolons or tabs decimals may have commas. Or a data frame, a mapping of names
        to columns, a table without names, (rows, columns), or one column.
    what
        What it is for, in errors: "signals".
    only
        Columns to take, of those there are, in this order; None takes all but those without a name, which
        pandas writes to count the rows.
    needed
        Columns that there must be.
    names
        Of the columns of a table without names, if it has so many.

    Raises
    ------
    ArenaError
        When it cannot be read, lacks a column, or holds something that is not a number.
    """
    is_file = isinstance(source, str | Path)
    label = str(source) if is_file else f"the table of {what}"
    frame = _read(user_path(source), label) if is_file else _framed(source, label, names)
    frame.columns = [str(name).strip() for name in frame.columns]
    twice = frame.columns[frame.columns.duplicated()]
    if len(twice):
        raise ArenaError(f"{label} has two columns {twice[0]}; rename one of them")
    named = [name for name in frame.columns if not re.fullmatch(r"(Unnamed: \d+)?", name)]
    lacking = [name for name in needed if name not in named]
    if lacking:
        raise ArenaError(f"{label} has no column {lacking[0]}; it has {', '.join(named)}")
    at = next((name for name in named if name.casefold() in TIMES and name not in (only or ())), None)
    wanted = [name for name in (named if only is None else only) if name != at and name in named]
    columns = {name: _numbers(frame[name], name, label) for name in wanted}
    if not len(frame):
        raise ArenaError(f"{label} has no rows; give at least one")
    return Table(label, None if at is None else _times(_numbers(frame[at], at, label), label), columns)


def times_of(source: Any) -> Float64[np.ndarray, " rows"]:
    """Read times (s): the column of a table that is named so, or its only one.

    Raises
    ------
    ArenaError
        As `table_of`; when there is no such column, and for times that do not increase.
    """
    table = table_of(source, "times")
    if table.times is not None:
        return table.times
    if len(table.columns) != 1:
        raise ArenaError(
            f"{table.label} has columns {', '.join(table.columns)}, none of them named {', '.join(TIMES)}; "
            "name the times (s)"
        )
    return _times(next(iter(table.columns.values())), table.label)


def _times(times: Float64[np.ndarray, " rows"], label: str) -> Float64[np.ndarray, " rows"]:
    if not np.isfinite(times).all():
        lost = int((~np.isfinite(times)).sum())
        raise ArenaError(f"{label} has {lost} rows without a time; leave them out")
    late = np.flatnonzero(np.diff(times) <= 0)
    if len(late):
        before, after = times[late[0] : late[0] + 2]
        raise ArenaError(
            f"{label}: the times do not increase in row {late[0] + 2}, where {after:g} s follows "
            f"{before:g} s; sort the rows and keep one a time"
        )
    return times


def _read(path: Path, label: str) -> pd.DataFrame:
    try:
        if path.suffix.lower() in {".parquet", ".pq"}:
            return pd.read_parquet(io.BytesIO(path.read_bytes()))
        return _delimited(path.read_bytes(), label)
    except OSError as error:
        raise ArenaError(f"cannot read {label}: {error.strerror or str(error).splitlines()[0]}") from None
    except (ValueError, pd.errors.ParserWarning) as error:
        if isinstance(error, ArenaError):
            raise
        why = (str(error).splitlines() or ["it is damaged"])[0]
        raise ArenaError(f"cannot read {label} ({why}); give CSV with a line of names, or Parquet") from None


def _delimited(content: bytes, label: str) -> pd.DataFrame:
    """Read a CSV file."""
    marked = content.startswith((b"\xff\xfe", b"\xfe\xff"))
    text = content.decode("utf-16" if marked else "utf-8-sig")
    head, _, body = text.lstrip("\r\n").partition("\n")
    separator = next((mark for mark in (";", "\t", ",") if mark in head), ",")
    # A comma that does not part cells is a decimal one, if no point is.
    comma = separator != "," and "," in body and "." not in body
    words = [word.strip().strip('"') for word in head.split(separator)]
    if len(words) > 1 and all(map(_is_number, words)):
        raise ArenaError(f"{label} has no line of names: it begins with {words[0]}, {words[1]}; add one")
    with warnings.catch_warnings():
        # Of rows longer than the line of names pandas would take what fits.
        warnings.simplefilter("error", pd.errors.ParserWarning)
        return pd.read_csv(
            io.StringIO(text),
            sep=separator,
            decimal="," if comma else ".",
            skipinitialspace=True,
            # One column without a name is clear.
            header=None if len(words) == 1 and _is_number(words[0]) else 0,
            index_col=False,
        )


def _is_number(word: str) -> bool:
    try:
        float(word.replace(",", "."))
    except ValueError:
        return False
    return True


def _framed(source: Any, label: str, names: Sequence[str]) -> pd.DataFrame:
    """Make a data frame of what is in memory."""
    try:
        if isinstance(source, Mapping):
            return pd.DataFrame({name: np.asarray(column) for name, column in source.items()})
        if isinstance(source, pd.DataFrame):
            return source.copy()
        values = np.asarray(source)
        width = values.shape[1] if values.ndim == 2 else 1
        plain = [f"column_{at + 1}" for at in range(width)]
        return pd.DataFrame(values, columns=list(names) if len(names) == width else plain)
    except ValueError as error:
        raise ArenaError(f"{label} is no table ({error}); give a data frame or named columns") from None


def _numbers(column: "pd.Series[Any]", name: str, label: str) -> Float64[np.ndarray, " rows"]:
    if column.dtype.kind in "biuf":
        return column.to_numpy(np.float64, na_value=np.nan)
    words = column.astype("string").str.strip()
    numbers = pd.to_numeric(words, errors="coerce").to_numpy(np.float64, na_value=np.nan)
    empty = (words.isna() | words.str.casefold().isin(["", "nan", "na", "none", "null"])).to_numpy(bool)
    wrong = np.flatnonzero(np.isnan(numbers) & ~empty)
    if len(wrong):
        found = words.iloc[wrong[0]]
        raise ArenaError(
            f"{label}: {name} is {found!r} in row {wrong[0] + 1}; give numbers there, or say which columns "
            "to take"
        )
    return numbers
