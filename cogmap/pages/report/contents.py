"""Contents of a folder of results: figures, numbers, tables, and what wrote them."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
import pandas as pd
from pyarrow import ArrowException

from arena.atomic import recover
from cogmap.atomic import METRICS
from cogmap.errors import CogmapError
from cogmap.experiments.provenance import PROVENANCE
from cogmap.experiments.registry import experiments
from cogmap.experiments.result import CAPTIONS
from cogmap.experiments.sessions import CELLS
from cogmap.tables import as_rows, shown

LONGEST = 500
"""Rows of a sweep's table that are shown."""
_Read = TypeVar("_Read")


class Picture(NamedTuple):
    """A figure, whole."""

    name: str
    caption: str
    uri: str
    """A data URI."""
    width: int
    height: int


class Table(NamedTuple):
    """Cells as they are printed."""

    name: str
    note: str
    columns: list[str]
    rows: list[list[str]]
    opened: bool
    """Whether it is the result itself rather than the data behind a figure."""


@dataclass(frozen=True)
class Contents:
    """Everything that a report shows."""

    title: str
    summary: str
    """What the experiment does; empty for any other result."""
    parameters: list[tuple[str, str, str]]
    """Name, value and unit of what was given."""
    figures: list[tuple[str, str, str]]
    """Name, value and unit of what was found."""
    pictures: list[Picture]
    tables: list[Table]
    files: dict[str, str]
    """Text of rooms and plans, by the name of the file."""
    command: str
    """That repeats it; empty when nobody wrote it down."""
    versions: dict[str, str]


def read_contents(folder: Path) -> Contents:
    """Read what a demo, an experiment or a sweep left in a folder.

    Raises
    ------
    CogmapError
        When it is no such folder, or a file in it is damaged.
    """
    recover(folder)
    swept = ("table.parquet", "table.csv")
    table = next((folder / name for name in swept if (folder / name).is_file()), None)
    if not (folder / METRICS).is_file() and table is None:
        raise CogmapError(
            f"{folder} is not the result of a demo, an experiment or a sweep: it has neither {METRICS} nor "
            f"{swept[1]}; give a folder that one of them wrote"
        )
    metrics, about, captions = (
        _read(folder / name, _record) if (folder / name).is_file() else {}
        for name in (METRICS, PROVENANCE, CAPTIONS)
    )
    # Metrics that were not found but given.
    parameters = ("experiment", "arena", "views", "charts", "seed")
    given = {name: metrics[name] for name in parameters if name in metrics}
    found = {name: value for name, value in metrics.items() if name not in given}
    kind = "sweep" if table is not None else str(given.get("experiment", "demo"))
    place = f" in {given['arena']}" if "arena" in given else ""
    chosen = experiments().get(kind)
    # Those of cells are read cell by cell, not as what is behind figures.
    show = _whole if kind == CELLS else _summary
    behind = [path for path in sorted(folder.glob("*.parquet")) if path.name not in swept]
    return Contents(
        title=f"{kind.replace('_', ' ').capitalize()}{place}",
        summary=chosen.summary if chosen else "",
        parameters=as_rows({**given, **about.get("different", {})}),
        figures=as_rows(found),
        pictures=[
            _read(path, lambda path: _picture(path, folder, captions))
            for path in sorted(folder.rglob("*.png"))
        ],
        tables=[
            *([] if table is None else [_read(table, _whole)]),
            *(_read(path, show) for path in behind),
        ],
        files={path.name: _read(path, _text) for path in sorted(folder.glob("*.toml"))},
        command=about.get("command", ""),
        versions=about.get("versions", {}),
    )


def _read(path: Path, how: Callable[[Path], _Read]) -> _Read:
    try:
        return how(path)
    except OSError as error:
        raise CogmapError(f"cannot read {path}: {error.strerror or error}") from None
    except (ValueError, ArrowException) as error:
        raise CogmapError(f"{path} is damaged: {error}; run what wrote it again") from None


def _record(path: Path) -> dict[str, Any]:
    record = json.loads(path.read_text("utf-8"))
    if not isinstance(record, dict):
        raise ValueError("it holds no record")  # noqa: TRY004
    return record


def _text(path: Path) -> str:
    return path.read_text("utf-8")


def _picture(path: Path, folder: Path, captions: dict[str, str]) -> Picture:
    """Read a figure; one without a caption has only its name."""
    data = path.read_bytes()
    if not data.startswith(b"\x89PNG\r\n\x1a\n") or len(data) < 24:
        raise ValueError("it is no PNG picture")
    width, height = (int.from_bytes(data[start : start + 4]) for start in (16, 20))
    name = path.relative_to(folder).with_suffix("").as_posix()
    caption = captions.get(path.stem, path.stem.replace("_", " ").capitalize())
    uri = f"data:image/png;base64,{base64.b64encode(data).decode()}"
    return Picture(name, caption, uri, width, height)


def _whole(path: Path) -> Table:
    """Print the rows themselves."""
    table = pd.read_parquet(path) if path.suffix == ".parquet" else pd.read_csv(path)
    rows = [[_cell(value) for value in row] for row in table.head(LONGEST).itertuples(index=False)]
    cut = f", the first {LONGEST} of which are shown" if len(table) > LONGEST else ""
    return Table(path.name, f"{len(table)} rows{cut}", [str(name) for name in table], rows, opened=True)


def _summary(path: Path) -> Table:
    """Print one row per column, with its range where it is a number."""
    table = pd.read_parquet(path)
    rows = []
    for name, values in table.items():
        if pd.api.types.is_numeric_dtype(values) and not pd.api.types.is_bool_dtype(values):
            spread = [_cell(float(values.quantile(share))) for share in (0, 0.5, 1)]
        else:
            spread = ["", f"{values.nunique()} different", ""]
        rows.append([str(name), *spread])
    columns = ["column", "least", "median", "greatest"]
    return Table(path.name, f"{len(table)} rows", columns, rows, opened=False)


def _cell(value: object) -> str:
    if value is None or (isinstance(value, float) and np.isnan(value)):
        return "–"
    return shown(value)
