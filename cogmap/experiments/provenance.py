"""Provenance of a result: the command that repeats it, the versions and the arithmetic it stood on."""

from __future__ import annotations

import json
import platform
import shlex
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from arena import Arena, gallery
from arena.atomic import atomic_write
from cogmap.portable import arithmetic

PROVENANCE = "about.json"
ROOM = "arena.toml"
"""The room of a result, where the gallery has no such room."""
PACKAGES = (
    "cogmap", "gudhi", "numba", "numpy", "opencv-python-headless", "pymunk", "ripser", "scikit-learn",
    "scipy", "torch",
)  # fmt: skip
"""Those whose version may change a figure."""


def write_provenance(folder: Path, words: tuple[str, ...], room: Arena | None, **options: Any) -> None:
    """Write `about.json`, and the room where it is none of the gallery; no times, no names of machines.

    Parameters
    ----------
    folder
        Of the result.
    words
        Of the command: `("demo",)` or `("experiment", "rotation")`.
    room
        Where it took place; None where the command takes no room.
    options
        Those of the command. What the command line cannot say, being neither number nor text, is kept as
        `different`.
    """
    said = {key: value for key, value in options.items() if isinstance(value, int | float | str)}
    command = [*words, *_where(folder, room), *(word for item in said.items() for word in _option(*item))]
    about = {
        "command": shlex.join(["cogmap", *command]),
        "different": {key: repr(value) for key, value in options.items() if key not in said},
        "versions": {"python": platform.python_version(), **{name: _version(name) for name in PACKAGES}},
        "arithmetic": arithmetic(),
    }
    with atomic_write(folder / PROVENANCE) as fresh:
        fresh.write_text(json.dumps(about, indent=2) + "\n", encoding="utf-8")


def _where(folder: Path, room: Arena | None) -> tuple[str, ...]:
    """Name the room, and keep it where its name does not tell it."""
    if room is None:
        return ()
    if room.name in gallery() and Arena.load(room.name) == room:
        return _option("arena", room.name)
    (folder / ROOM).write_text(room.to_toml(), encoding="utf-8")
    return _option("arena", ROOM)


def _option(name: str, value: object) -> tuple[str, str]:
    return f"--{name}", str(value)


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"
