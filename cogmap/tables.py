"""Results as a table that reads well in a terminal."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

UNITS = {"_m": "m", "_deg": "°", "_bytes": "bytes"}


def as_table(metrics: Mapping[str, Any]) -> str:
    """Lay out a record as lines of name, value and unit; names of nested records are joined by dots."""
    flat: dict[str, Any] = {}
    for name, value in metrics.items():
        if isinstance(value, Mapping):
            flat |= {f"{name}.{key}": part for key, part in _flat(value).items()}
        else:
            flat[name] = value
    rows = [(name, _shown(value), _unit(name)) for name, value in flat.items() if value != ""]
    return pd.DataFrame(rows, columns=["figure", "value", "unit"]).to_string(index=False)


def _flat(record: Mapping[str, Any]) -> dict[str, Any]:
    parts: dict[str, Any] = {}
    for name, value in record.items():
        if isinstance(value, Mapping):
            parts |= {f"{name}.{key}": part for key, part in _flat(value).items()}
        else:
            parts[name] = value
    return parts


def _shown(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _unit(name: str) -> str:
    if "seconds" in name:
        return "s"
    return next((unit for ending, unit in UNITS.items() if name.endswith(ending)), "")
