"""Storage on disk: a folder with weights and settings, neither of which can run code."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import google_crc32c
import numpy as np
from safetensors import SafetensorError
from safetensors.torch import load_file, save_file
from torch import Tensor

from cogmap.atomic import atomic_write, user_path
from cogmap.digests import digest
from cogmap.errors import CogmapError

Kind = Literal["map", "memory", "motor", "coordinates"]
VERSIONS: dict[Kind, int] = {"map": 8, "memory": 2, "motor": 2, "coordinates": 2}
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
    kept = {name: weight.cpu().contiguous() for name, weight in weights.items()}
    described: dict[str, Any] = {
        "version": VERSIONS[kind],
        "settings": {name: _plain(value) for name, value in settings.items()},
        "learnt": dict(learnt),
        "weights": {name: _checksum(weight) for name, weight in kept.items()},
    }
    described["digest"] = digest(described)
    with atomic_write(user_path(path), overwrite=False) as folder:
        folder.mkdir()
        save_file(kept, folder / WEIGHTS)
        (folder / f"{kind}.json").write_text(json.dumps(described, indent=2) + "\n", encoding="utf-8")


def _plain(value: Any) -> Any:
    """Give a number of numpy's as Python's, which JSON knows, and refuse what it does not know."""
    if isinstance(value, np.generic):
        return value.item()
    try:
        json.dumps(value)
    except TypeError:
        raise CogmapError(
            f"{value!r} cannot be saved; give settings that are numbers, words or None"
        ) from None
    return value


def read_state(
    path: str | Path, *, kind: Kind = "map"
) -> tuple[dict[str, Tensor], dict[str, Any], dict[str, Any]]:
    """Read weights, settings and what was learnt about the input, each compared with its checksum.

    Raises
    ------
    CogmapError
        When it is missing, of another version or no longer what was written, with what it is that is damaged.
    """
    path = user_path(path)
    try:
        described = json.loads((path / f"{kind}.json").read_text(encoding="utf-8"))
        weights = load_file(path / WEIGHTS)
    except OSError as error:
        raise CogmapError(f"cannot read a {kind} at {path}: {error.strerror or error}") from None
    except (ValueError, RecursionError, SafetensorError) as error:
        raise CogmapError(f"{path} is damaged or not a {kind}: {error}") from None
    version = described.get("version") if isinstance(described, dict) else None
    if version != VERSIONS[kind]:
        raise CogmapError(
            f"{path} is a {kind} of version {version!r}, not {VERSIONS[kind]}; learn it again, "
            "or load it with the program that wrote it"
        )
    if described.pop("digest", None) != digest(described):
        raise _damaged(path, f"{kind}.json is not what was written")
    wanted = described["weights"]
    if lost := sorted(wanted.keys() ^ weights.keys()):
        raise _damaged(path, f"{WEIGHTS} does not hold the weights it was written with, as {lost[0]}")
    for name, weight in weights.items():
        if _checksum(weight) != wanted[name]:
            raise _damaged(path, f"the weight {name} does not match its checksum")
    return weights, described["settings"], described["learnt"]


def _damaged(path: Path, what: str) -> CogmapError:
    return CogmapError(f"{path} is damaged: {what}; learn it again, or use a copy of it")


def _checksum(weight: Tensor) -> str:
    """Give the CRC-32C of type, shape and bytes: no single bit can flip without changing it."""
    array = weight.numpy()
    head = google_crc32c.value(f"{array.dtype} {array.shape}".encode())
    return f"{google_crc32c.extend(head, array.tobytes()):08x}"
