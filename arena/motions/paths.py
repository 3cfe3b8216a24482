"""Recorded paths of animals: CSV or NPZ files in, checked arrays out."""

import csv
import zipfile
import zlib
from collections.abc import Container, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from arena.errors import ArenaError

_NAMES = ("t", "x", "y", "heading", "heading_deg")
# What numpy has been seen to raise on archives that are no archives, or cut short.
_DAMAGE = (ValueError, LookupError, RuntimeError, EOFError, csv.Error, zipfile.BadZipFile, zlib.error)


Times = Float[np.ndarray, " samples"]
Positions = Float[np.ndarray, "samples 2"]


class RecordedPath(NamedTuple):
    """Where an animal was, as recorded: NaN where the tracker lost it, or its head."""

    times: Times
    """s, increasing."""
    positions: Positions
    headings: Float[np.ndarray, " samples"] | None
    """rad."""


def read_path(path: Path) -> RecordedPath:
    """Read a recorded path.

    A CSV file starts with a line of names: `t` (s), `x`, `y` and, optionally, `heading` (rad) or
    `heading_deg`; other columns are left alone. A position or heading that is empty or `nan` is missing. An
    NPZ file holds arrays of the same names, or `pos`, (samples, 2), for x and y.

    Raises
    ------
    ArenaError
        When the file cannot be read, lacks a column, holds something that is not a number, has fewer than two
        positions, or times that do not increase.
    """
    columns, rows = _read(path, _NAMES)
    missing = [name for name in ("t", "x", "y") if name not in columns]
    if missing:
        raise ArenaError(
            f"{path} has no column {' and no '.join(missing)}; it must have t (s), x and y, "
            "and may have heading (rad) or heading_deg"
        )
    if "heading" in columns and "heading_deg" in columns:
        raise ArenaError(f"{path} has both heading and heading_deg; leave one of them out")
    _check(path, columns, rows)
    headings = columns.get("heading")
    if "heading_deg" in columns:
        headings = np.deg2rad(columns["heading_deg"])
    return RecordedPath(columns["t"], np.stack([columns["x"], columns["y"]], axis=1), headings)


def read_joints(path: Path, names: Sequence[str]) -> tuple[Times, Float[np.ndarray, "samples axes"]]:
    """Read a recorded path of joints: `t` (s), and a column for each axis by its name, none of it missing.

    Raises
    ------
    ArenaError
        As `read_path`, and where a sample has no number.
    """
    columns, rows = _read(path, ("t", *names))
    missing = [name for name in ("t", *names) if name not in columns]
    if missing:
        raise ArenaError(
            f"{path} has no column {' and no '.join(missing)}; it must have t, {', '.join(names)}"
        )
    _check_numbers(path, columns, rows, columns.keys())
    return columns["t"], np.stack([columns[name] for name in names], axis=1)


def _read(path: Path, names: Sequence[str]) -> tuple[dict[str, np.ndarray], Int[np.ndarray, " samples"]]:
    """Read the columns of these names that there are, and in which row of the file each sample is."""
    readers = {".csv": _read_csv, ".npz": _read_npz}
    if path.suffix not in readers:
        raise ArenaError(f"{path} is neither a .csv nor a .npz file; a recorded path must be one of them")
    try:
        return readers[path.suffix](path, names)
    except ArenaError:
        raise
    except OSError as error:
        raise ArenaError(f"cannot read the path {path}: {error.strerror or error}") from None
    except _DAMAGE:
        raise ArenaError(
            f"cannot read the path {path}: it is damaged, of another kind or holds Python objects"
        ) from None


def _check_numbers(
    path: Path, columns: Mapping[str, np.ndarray], rows: Int[np.ndarray, " samples"], whole: Container[str]
) -> None:
    """Raise for infinite values, for missing ones in whole columns, and for times that do not increase."""
    for name, values in columns.items():
        wrong = ~np.isfinite(values) if name in whole else np.isinf(values)
        if wrong.any():
            first = np.flatnonzero(wrong)[0]
            raise ArenaError(f"{path}: row {rows[first]} has {name} = {values[first]}; give a finite number")
    late = np.flatnonzero(np.diff(columns["t"]) <= 0)
    if len(late):
        before, after = columns["t"][late[0] : late[0] + 2]
        raise ArenaError(
            f"{path}: the times do not increase at row {rows[late[0] + 1]}, where {after:g} s follows "
            f"{before:g} s; sort the rows and keep one a time"
        )


def _check(path: Path, columns: Mapping[str, np.ndarray], rows: Int[np.ndarray, " samples"]) -> None:
    _check_numbers(path, columns, rows, ("t",))
    known = np.isfinite(columns["x"]) & np.isfinite(columns["y"])
    if known.sum() < 2:
        raise ArenaError(f"{path} has {known.sum()} positions that are numbers; a path needs at least two")
    if not np.isfinite(columns.get("heading", columns.get("heading_deg", np.zeros(1)))).any():
        raise ArenaError(f"{path} has a heading column without a number; leave it out")


def _read_csv(path: Path, names: Sequence[str]) -> tuple[dict[str, np.ndarray], Int[np.ndarray, " samples"]]:
    with path.open(encoding="utf-8-sig", newline="") as file:
        lines = csv.reader(file, strict=True)
        head = [name.strip() for name in next(lines, [])]
        wanted = {name: head.index(name) for name in names if name in head}
        rows, columns = list[int](), [list[float]() for _ in wanted]
        for cells in lines:
            if not cells:
                continue
            if len(cells) != len(head):
                raise ArenaError(
                    f"{path}: row {lines.line_num} has {len(cells)} cells, not {len(head)}; fill it up"
                )
            rows.append(lines.line_num)
            for column, (name, index) in zip(columns, wanted.items(), strict=True):
                try:
                    column.append(float(cells[index].strip() or "nan"))
                except ValueError:
                    raise ArenaError(
                        f"{path}: row {lines.line_num} has {name} = {cells[index]!r}; give a number, "
                        "or nothing where it is missing"
                    ) from None
    return dict(zip(wanted, map(np.array, columns), strict=True)), np.array(rows, dtype=int)


def _read_npz(path: Path, names: Sequence[str]) -> tuple[dict[str, np.ndarray], Int[np.ndarray, " samples"]]:
    with zipfile.ZipFile(path):  # An NPY file by the name of NPZ would load too.
        loaded = np.load(path, allow_pickle=False)
    with loaded:
        arrays = {name: loaded[name] for name in (*names, "pos") if name in loaded}
    if "pos" in arrays:
        pos = arrays.pop("pos")
        if pos.ndim != 2 or pos.shape[1] != 2:
            raise ArenaError(f"{path}: pos has shape {pos.shape}; it must be (samples, 2)")
        arrays |= {"x": pos[:, 0], "y": pos[:, 1]}
    sizes = {name: array.shape for name, array in arrays.items()}
    if any(array.ndim != 1 or array.dtype.kind not in "fiu" for array in arrays.values()):
        raise ArenaError(f"{path}: {sizes} must all be rows of numbers")
    if len(set(sizes.values())) > 1:
        raise ArenaError(f"{path}: its arrays differ in length, {sizes}; give one of each a sample")
    columns = {name: array.astype(float) for name, array in arrays.items()}
    return columns, np.arange(len(next(iter(columns.values()), [])))
