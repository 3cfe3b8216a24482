"""The result of an experiment, and how it is written down."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from cogmap.atomic import METRICS
from cogmap.tables import write_table

CAPTIONS = "captions.json"
USUAL_CAPTIONS = {
    "barcodes": "Bars of loops and voids, each with the threshold above which it counts",
    "cells": "What each cell tells of position and of heading, by population",
    "distances": "Distance along the manifold against distance between poses",
    "examples": "Six cells of each population: rate maps, and rate by heading",
    "heading": "Heading read off the views against the true one",
    "room": "The room from above, with the way through it",
    "views": "Some of the views, with where they were taken",
}
"""By the name of a figure that several experiments draw."""


@dataclass(frozen=True)
class Result:
    """Figures of an experiment, the data behind them, and pictures of both."""

    metrics: dict[str, Any]
    """Values that JSON knows; the keys are the same wherever they occur."""
    tables: dict[str, pd.DataFrame] = field(default_factory=dict)
    """One row per view, pair or place; names of columns end in their unit."""
    figures: dict[str, Figure] = field(default_factory=dict)
    captions: dict[str, str] = field(default_factory=dict)
    """What each figure shows, for those who read it and for those who cannot see it; the usual ones may be
    left out."""

    def joined(self, other: Result) -> Result:
        """Add what another tells, which goes before where both tell the same."""
        return Result(
            {**self.metrics, **other.metrics},
            {**self.tables, **other.tables},
            {**self.figures, **other.figures},
            {**self.captions, **other.captions},
        )

    def described(self, about: dict[str, Any]) -> Result:
        """Put before the metrics what they are of, and give figures without a caption the usual one."""
        known = USUAL_CAPTIONS | self.captions
        captions = {name: known[name] for name in self.figures if name in known}
        return replace(self, metrics={**about, **self.metrics}, captions=captions)

    def write(self, folder: Path) -> None:
        """Write metrics and captions as JSON, tables as Parquet and CSV, figures as PNG into a folder."""
        for name, table in self.tables.items():
            for ending in ("parquet", "csv"):
                write_table(table, folder / f"{name}.{ending}")
        for name, figure in self.figures.items():
            figure.savefig(folder / f"{name}.png")
        for name, record in ((CAPTIONS, self.captions), (METRICS, self.metrics)):
            (folder / name).write_text(json.dumps(record, indent=2) + "\n", encoding="utf-8")
