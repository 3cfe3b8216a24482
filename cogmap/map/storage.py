"""Storage on disk: a folder with weights and settings, neither of which can run code."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np
from safetensors import SafetensorError
from safetensors.torch import load_file, save_file
from torch import Tensor

from cogmap.atomic import atomic_write, user_path
from cogmap.errors import CogmapError

Kind = Literal["map", "memory", "motor", "coordinates"]
VERSIONS: dict[Kind, int] = {"map": 5, "memory": 1, "motor": 1, "coordinates": 1}
WEIGHTS = "weights.safetensors"


def write_state(
    path: str | Path,
    weights: Mapping[str, Tensor],
    settings: Mapping[str, Any],
    learnt: Mapping[str, Any],
    *,
    kind: Kind = "map",
) -> None:
    """Fill a new folder under another name and give it the right one at the end."""
    described = {"version": VERSIONS[kind], "settings": dict(settings), "learnt": dict(learnt)}
    with atomic_write(user_path(path), overwrite=False) as folder:
        folder.mkdir()
        save_file({name: weight.cpu().contiguous() for name, weight in weights.items()}, folder / WEIGHTS)
        text = json.dumps(described, indent=2, default=_plain)
        (folder / f"{kind}.json").write_text(text + "\n", encoding="utf-8")


def _plain(number: Any) -> Any:
    """Give what JSON does not know by itself, a number of numpy's, as Python's."""
    if not isinstance(number, np.generic):
        raise CogmapError(f"{number!r} cannot be saved; give settings that are numbers, words or None")
    return number.item()


def read_state(
    path: str | Path, *, kind: Kind = "map"
) -> tuple[dict[str, Tensor], dict[str, Any], dict[str, Any]]:
    """Read weights, settings and what was learnt about the input."""
    path = user_path(path)
    try:
        described = json.loads((path / f"{kind}.json").read_text(encoding="utf-8"))
        weights = load_file(path / WEIGHTS)
    except OSError as error:
        raise CogmapError(f"cannot read a {kind} at {path}: {error.strerror or error}") from None
    except (ValueError, SafetensorError) as error:
        raise CogmapError(f"{path} is damaged or not a {kind}: {error}") from None
    version = described.get("version") if isinstance(described, dict) else None
    if version != VERSIONS[kind]:
        raise CogmapError(
            f"{path} is a {kind} of version {version!r}, not {VERSIONS[kind]}; learn it again, "
            "or load it with the program that wrote it"
        )
    try:
        return weights, described["settings"], described["learnt"]
    except KeyError as error:
        raise CogmapError(f"{path} is damaged: {kind}.json lacks {error}") from None
