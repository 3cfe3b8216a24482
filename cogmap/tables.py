"""Tables of results: as Parquet and CSV on disk, and as lines that read well in a terminal."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd


def write_table(table: pd.DataFrame, path: Path) -> None:
    """Write a table as CSV where its path ends so, or else as Parquet."""
    if path.suffix == ".csv":
        table.to_csv(path, index=False)
    else:
        table.to_parquet(path, index=False)


def as_table(metrics: Mapping[str, Any]) -> str:
    """Lay out a record as lines of name, value and unit; names of nested records are joined by dots."""
    return pd.DataFrame(as_rows(metrics), columns=["figure", "value", "unit"]).to_string(index=False)


def as_markdown(rows: Sequence[Mapping[str, str]]) -> str:
    """Lay out records of the same keys as a table in Markdown."""
    lines = [list(rows[0]), ["---"] * len(rows[0]), *(list(row.values()) for row in rows)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def as_rows(metrics: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Give name, value and unit of each entry that is not empty, those of nested records too."""
    return [(name, shown(value), _unit(name)) for name, value in flat(metrics).items() if value != ""]


def shown(value: object) -> str:
    """Print a value, a fraction with four digits."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def flat(record: Mapping[str, Any], *, lists: bool = False) -> dict[str, Any]:
    """Lay out a nested record in one: names joined by dots, and those of the entries of lists by index."""
    parts: dict[str, Any] = {}
    for name, value in record.items():
        nested = value
        if lists and isinstance(value, list | tuple):
            nested = {str(index): part for index, part in enumerate(value)}
        if isinstance(nested, Mapping):
            parts |= {f"{name}.{key}": part for key, part in flat(nested, lists=lists).items()}
        else:
            parts[name] = value
    return parts


def _unit(name: str) -> str:
    if "seconds" in name:
        return "s"
    units = {"_m": "m", "_deg": "°", "_bytes": "bytes"}
    return next((unit for ending, unit in units.items() if name.endswith(ending)), "")
