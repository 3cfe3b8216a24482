"""What all commands share: their app, their options, and how they answer."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated, Any

from cyclopts import App, Parameter
from matplotlib.figure import Figure

from arena import Recording
from cogmap.atomic import atomic_write
from cogmap.errors import CogmapError
from cogmap.tables import as_table

app = App(
    name="cogmap",
    help="Grow place cells and head-direction cells from sight and smell alone.",
    version_flags=["--version"],
    result_action="return_value",
)

Json = Annotated[bool, Parameter(name="--json", negative="", help="Print metrics as JSON on stdout.")]
Seed = Annotated[int, Parameter(help="Of everything random; the same seed gives the same arrays.")]


def with_truth(path: Path) -> Recording:
    """Open a recording that has poses."""
    recording = Recording.open(path)
    if recording.poses is None:
        raise CogmapError(f"{path} has no poses to score against; use a recording that kept them")
    return recording


def save_figure(figure: Figure, path: Path) -> None:
    """Write a PNG into a folder that is there: a mistyped one is not made."""
    if not path.parent.is_dir():
        raise CogmapError(f"cannot write {path}: No such file or directory")
    with atomic_write(path) as fresh:
        figure.savefig(fresh, format="png")


def tell(metrics: dict[str, Any], *, as_json: bool) -> None:
    """Print metrics on stdout, as JSON or as a table."""
    text = json.dumps(metrics, indent=2) if as_json else as_table(metrics)
    sys.stdout.write(text + "\n")
