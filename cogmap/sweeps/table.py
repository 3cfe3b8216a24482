"""The tidy table of a sweep: a row for each point and seed."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from cogmap.sweeps.ledger import Record
from cogmap.sweeps.points import Point
from cogmap.tables import flat

OF_THE_MACHINE = re.compile(r"(^|[._])(seconds?|ms|memory|host)($|[._])")
"""Names of figures that are others on each run."""
ALWAYS = ("trusted", "reason", "error")
"""Columns that every table ends with."""


def comparable(metrics: Mapping[str, Any]) -> dict[str, Any]:
    """Lay out nested metrics in one row, lists by index; without time and memory, which differ by run."""
    row = flat(metrics, lists=True)
    return {name: value for name, value in row.items() if not OF_THE_MACHINE.search(name)}


def table_of(points: Sequence[Point], records: Sequence[Record]) -> pd.DataFrame:
    """Make the table: what varies, the seed, the metrics, then `trusted`, `reason` and `error`.

    A row is trusted when all its maps are; `reason` says why not, and `error` why there is nothing else.
    Sorted by what varies and the seed.
    """
    varied = list(points[0].varied)
    rows = [_row(point, record) for point, record in zip(points, records, strict=True)]
    names = list(dict.fromkeys(name for row in rows for name in row if name not in ALWAYS))
    table = pd.DataFrame({name: _column([row.get(name) for row in rows]) for name in [*names, *ALWAYS]})
    return table.sort_values([*varied, "seed"], kind="stable", ignore_index=True)


def _row(point: Point, record: Record) -> dict[str, Any]:
    metrics = record.get("metrics", {})
    verdicts = {name: value for name, value in metrics.items() if name.split(".")[-1] == "trusted"}
    reasons = [str(metrics[name]) for name in metrics if name.split(".")[-1] == "reason" and metrics[name]]
    doubted = [name for name, trusted in verdicts.items() if not trusted]
    about = {"experiment": point.experiment, "arena": point.room.name, "views": point.views}
    return {
        **{name: value for name, value in about.items() if name not in point.varied},
        **point.varied,
        "seed": point.seed,
        **{name: value for name, value in metrics.items() if name not in {*about, "seed", *ALWAYS}},
        "trusted": not doubted if verdicts else None,
        "reason": "; ".join(dict.fromkeys(reasons)) or ", ".join(doubted),
        "error": record.get("error", ""),
    }


def _column(values: list[Any]) -> pd.Series:
    """Give a column one type, whatever is missing: truth, whole numbers, numbers, or else text."""
    present = [value for value in values if value is not None]
    if all(isinstance(value, bool) for value in present):
        return pd.Series(values, dtype="boolean")
    if any(isinstance(value, bool) or not isinstance(value, int | float) for value in present):
        return pd.Series([value if value is None else str(value) for value in values], dtype="string")
    if all(isinstance(value, int) for value in values):
        return pd.Series(values, dtype="int64")
    return pd.Series(values, dtype="float64")
