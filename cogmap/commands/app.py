"""What all commands share: their app, their options, and how they answer."""

import json
import sys
from typing import Annotated, Any

from cyclopts import App, Parameter

from cogmap.tables import as_table

app = App(
    name="cogmap",
    help="Grow place cells and head-direction cells from sight and smell alone.",
    version_flags=["--version"],
    result_action="return_value",
)

Json = Annotated[bool, Parameter(name="--json", negative="", help="Print metrics as JSON on stdout.")]
Seed = Annotated[int, Parameter(help="Of everything random; the same seed gives the same arrays.")]


def tell(metrics: dict[str, Any], *, as_json: bool) -> None:
    """Print metrics on stdout, as JSON or as a table."""
    text = json.dumps(metrics, indent=2) if as_json else as_table(metrics)
    sys.stdout.write(text + "\n")
