"""What commands share: their options, and how they answer."""

import json
import sys
from typing import Annotated, Any

from cyclopts import Parameter

from cogmap.tables import as_table

Json = Annotated[bool, Parameter(name="--json", negative="", help="Print metrics as JSON on stdout.")]
Seed = Annotated[int, Parameter(help="Of everything random; the same seed gives the same arrays.")]


def tell(metrics: dict[str, Any], *, as_json: bool) -> None:
    """Print metrics on stdout, as JSON or as a table."""
    text = json.dumps(metrics, indent=2) if as_json else as_table(metrics)
    sys.stdout.write(text + "\n")
