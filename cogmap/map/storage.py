"""Storage of a map on disk: a folder with its weights and its settings, neither of which can run code."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from safetensors import SafetensorError
from safetensors.torch import load_file, save_file
from torch import Tensor

from cogmap.atomic import atomic_write
from cogmap.errors import CogmapError

VERSION = 4
WEIGHTS, SETTINGS = "weights.safetensors", "map.json"


def write_map(
    path: Path, weights: Mapping[str, Tensor], settings: Mapping[str, Any], learnt: Mapping[str, Any]
) -> None:
    """Fill a new folder under another name and give it the right one at the end."""
    described = {"version": VERSION, "settings": dict(settings), "learnt": dict(learnt)}
    with atomic_write(path, overwrite=False) as folder:
        folder.mkdir()
        save_file({name: weight.cpu().contiguous() for name, weight in weights.items()}, folder / WEIGHTS)
        (folder / SETTINGS).write_text(json.dumps(described, indent=2) + "\n", encoding="utf-8")


def read_map(path: Path) -> tuple[dict[str, Tensor], dict[str, Any], dict[str, Any]]:
    """Read weights, settings and what was learnt about the input."""
    try:
        described = json.loads((path / SETTINGS).read_text(encoding="utf-8"))
        weights = load_file(path / WEIGHTS)
    except OSError as error:
        raise CogmapError(f"cannot read a map at {path}: {error.strerror or error}") from None
    except (ValueError, SafetensorError) as error:
        raise CogmapError(f"{path} is damaged or not a map: {error}") from None
    version = described.get("version") if isinstance(described, dict) else None
    if version != VERSION:
        raise CogmapError(
            f"{path} is a map of version {version!r}, not {VERSION}; learn it again, "
            "or load it with the program that wrote it"
        )
    try:
        return weights, described["settings"], described["learnt"]
    except KeyError as error:
        raise CogmapError(f"{path} is damaged: {SETTINGS} lacks {error}") from None
