"""The result of an experiment, and how it is written down."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from cogmap.atomic import METRICS
from cogmap.tables import write_table


@dataclass(frozen=True)
class Result:
    """Figures of an experiment, the data behind them, and pictures of both."""

    metrics: dict[str, Any]
    """Values that JSON knows; the keys are the same wherever they occur."""
    tables: dict[str, pd.DataFrame] = field(default_factory=dict)
    """One row per view, pair or place; names of columns end in their unit."""
    figures: dict[str, Figure] = field(default_factory=dict)

    def write(self, folder: Path) -> None:
        """Write `metrics.json`, tables as Parquet and CSV, and figures as PNG into a folder that exists."""
        for name, table in self.tables.items():
            for ending in ("parquet", "csv"):
                write_table(table, folder / f"{name}.{ending}")
        for name, figure in self.figures.items():
            figure.savefig(folder / f"{name}.png")
        (folder / METRICS).write_text(json.dumps(self.metrics, indent=2) + "\n", encoding="utf-8")
