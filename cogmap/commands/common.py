"""What commands share: their options, and how they answer."""

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import cv2
import numpy as np
from cyclopts import Parameter, Token
from jaxtyping import UInt8

from cogmap.atomic import user_path
from cogmap.errors import CogmapError
from cogmap.tables import as_table

Json = Annotated[bool, Parameter(name="--json", negative="", help="Print metrics as JSON on stdout.")]
Told = Annotated[list[str] | None, Parameter(name="--set", negative="")]
Seed = Annotated[int, Parameter(help="Of everything random; the same seed gives the same arrays.")]


def _from_home(_: object, tokens: Sequence[Token]) -> Path:
    """Read a path as a shell does, also where none has read it: in `--out=~/map`, or without a shell."""
    return user_path(tokens[0].value)


UserPath = Annotated[Path, Parameter(converter=_from_home)]
MaybePath = Annotated[Path | None, Parameter(converter=_from_home)]


def tell(metrics: dict[str, Any], *, as_json: bool) -> None:
    """Print metrics on stdout, as JSON or as a table."""
    text = json.dumps(metrics, indent=2) if as_json else as_table(metrics)
    sys.stdout.write(text + "\n")


def read_image(path: Path, shape: tuple[int, ...]) -> UInt8[np.ndarray, "height width 3"]:
    """Read an RGB image of a size.

    Raises
    ------
    CogmapError
        For what is no image, or one of another size.
    """
    image = cv2.imread(str(path), cv2.IMREAD_COLOR) if path.is_file() else None
    if image is None:
        raise CogmapError(f"{path} is no image that can be read; give a PNG")
    if image.shape != tuple(shape):
        raise CogmapError(
            f"{path} has {image.shape[0]}×{image.shape[1]} pixels but the map was learnt from "
            f"{shape[0]}×{shape[1]}; take it with the camera the map was learnt with"
        )
    return np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2RGB))
