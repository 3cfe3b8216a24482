"""Columns of numbers by their names, from text, Parquet or NPZ."""

import csv
import zipfile
import zlib
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from arena.errors import ArenaError
from arena.recordings.delimited import Rows, layout_of, read_delimited, to_numbers

TEXT = (".csv", ".tsv", ".txt")
PARQUET = (".parquet", ".pq")
SHOWN = 12
"""Names of columns in an error."""
# What numpy and pyarrow have been seen to raise on archives that are no archives, or cut short.
_DAMAGE = (
    ValueError, LookupError, RuntimeError, EOFError, csv.Error, zipfile.BadZipFile, zlib.error,
)  # fmt: skip


def names_of(path: Path) -> tuple[str, ...]:
    """Give the names of a file's columns.

    A `.csv`, `.tsv` or `.txt` file is read as `arena.recordings.delimited` tells, a `.parquet` or `.pq` file
    has its own, and an `.npz` file its arrays; `pos`, (samples, 2), is `x` and `y`. Endings may be capitals.

    Raises
    ------
    ArenaError
        When it cannot be read, or is of another kind.
    """
    kind = _kind(path)
    with _reading(path):
        if kind in TEXT:
            return layout_of(path).names
        if kind in PARQUET:
            return tuple(_parquet(path).schema_arrow.names)
        with _npz(path) as arrays:
            names = [name for name in arrays.files if name != "pos"]
            return (*names, "x", "y") if "pos" in arrays else tuple(names)


def read_columns(
    path: Path, names: Collection[str], words: Collection[str] = ()
) -> tuple[dict[str, np.ndarray], Rows]:
    """Read columns of numbers, NaN where there is none, and say where in the file each sample is.

    Parameters
    ----------
    path
        A file as `names_of` takes.
    names
        Which columns, all of them among its names.
    words
        Those of them that are words, not numbers.

    Raises
    ------
    ArenaError
        When it cannot be read, lacks a name or has it twice, or holds something that is not a number.
    """
    found = names_of(path)
    check_names(path, found, names)
    numbers = [name for name in names if name not in words]
    with _reading(path):
        if _kind(path) in TEXT:
            cells, rows = read_delimited(path, layout_of(path), names)
            read = to_numbers(path, {name: cells[name] for name in numbers}, rows)
            return read | {name: np.array(cells[name], dtype=str) for name in words}, rows
        arrays = _parquet_columns(path, names) if _kind(path) in PARQUET else _npz_columns(path, names)
        _check_arrays(path, {name: arrays[name] for name in numbers})
        columns = {name: arrays[name].astype(str if name in words else float) for name in names}
        return columns, np.arange(len(next(iter(columns.values()), [])))


def check_names(path: Path, found: Collection[str], wanted: Collection[str], hint: str = "") -> None:
    """Raise for names that a file lacks or has twice, with those that were found.

    Raises
    ------
    ArenaError
        When there are such.
    """
    missing = [name for name in wanted if name not in found]
    if missing:
        raise ArenaError(
            f"{path} has no column {' and no '.join(missing)}; it has {listed(found)}{hint and f'; {hint}'}"
        )
    twice = [name for name in wanted if list(found).count(name) > 1]
    if twice:
        raise ArenaError(f"{path} has more than one column {twice[0]}; rename all but one")


def listed(found: Collection[str]) -> str:
    """Name some things that were found, quoting what is hard to read."""
    shown = [name if name.isprintable() and name.strip() else repr(name) for name in found]
    shown = [name if len(name) <= 40 else f"{name[:40]}…" for name in shown]
    more = len(shown) - SHOWN
    return ", ".join([*shown[:SHOWN], *([f"{more} more"] if more > 0 else [])]) or "none at all"


def _kind(path: Path) -> str:
    kind = path.suffix.lower()
    if kind not in {*TEXT, *PARQUET, ".npz"}:
        raise ArenaError(
            f"{path} is neither a .csv nor a .npz file, nor .tsv, .txt or .parquet; "
            "a recorded path must be one of them"
        )
    return kind


@contextmanager
def _reading(path: Path) -> Iterator[None]:
    """Say in one sentence what goes wrong while a file is read."""
    try:
        yield
    except ArenaError:
        raise
    except OSError as error:
        why = error.strerror or (str(error).splitlines() or ["it cannot be opened"])[0]
        raise ArenaError(f"cannot read {path}: {why}") from None
    except _DAMAGE:
        raise ArenaError(
            f"cannot read {path}: it is damaged, of another kind or holds Python objects"
        ) from None


def _parquet(path: Path) -> Any:
    import pyarrow.parquet as pq  # noqa: PLC0415  # half a second that only Parquet needs

    with path.open("rb"):  # a missing file is told as any other is
        return pq.ParquetFile(path)


def _parquet_columns(path: Path, names: Collection[str]) -> dict[str, np.ndarray]:
    table = _parquet(path).read(columns=list(names))
    return {name: table[name].to_numpy(zero_copy_only=False) for name in names}


@contextmanager
def _npz(path: Path) -> Iterator[Any]:
    with zipfile.ZipFile(path):  # An NPY file by the name of NPZ would load too.
        loaded = np.load(path, allow_pickle=False)
    with loaded:
        yield loaded


def _npz_columns(path: Path, names: Collection[str]) -> dict[str, np.ndarray]:
    with _npz(path) as loaded:
        axes = {"x", "y"} if "pos" in loaded else set()
        arrays = {name: loaded[name] for name in names if name not in axes}
        pos = loaded["pos"] if axes & set(names) else np.empty((0, 2))
    if pos.ndim != 2 or pos.shape[1] != 2:
        raise ArenaError(f"{path}: pos has shape {pos.shape}; it must be (samples, 2)")
    return arrays | {name: pos[:, "xy".index(name)] for name in names if name in axes}


def _check_arrays(path: Path, arrays: dict[str, np.ndarray]) -> None:
    sizes = {name: array.shape for name, array in arrays.items()}
    if any(array.ndim != 1 or array.dtype.kind not in "fiu" for array in arrays.values()):
        kinds = {name: str(array.dtype) for name, array in arrays.items()}
        raise ArenaError(f"{path}: {sizes} must all be rows of numbers, and they are {kinds}")
    if len(set(sizes.values())) > 1:
        raise ArenaError(f"{path}: its arrays differ in length, {sizes}; give one of each a sample")
