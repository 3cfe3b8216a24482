"""What wrote a result: the command that repeats it, and the versions of everything it stood on."""

from __future__ import annotations

import json
import platform
import shlex
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from arena import Arena, gallery

ABOUT = "about.json"
ROOM = "arena.toml"
"""The room of a result, where the gallery has no such room."""
PACKAGES = (
    "cogmap", "gudhi", "numba", "numpy", "opencv-python-headless", "pymunk", "ripser", "scikit-learn",
    "scipy", "torch",
)  # fmt: skip
"""Those whose version may change a figure."""


def write_about(folder: Path, words: tuple[str, ...], room: Arena, **options: Any) -> None:
    """Write `about.json`, and the room where it is none of the gallery; no times, no names of machines.

    Parameters
    ----------
    folder
        Of the result.
    words
        Of the command: `("demo",)` or `("experiment", "rotation")`.
    room
        Where it took place.
    options
        Those of the command. What the command line cannot say, being neither number nor text, is kept as
        `different`.
    """
    name = room.name
    if name not in gallery() or Arena.load(name) != room:
        (folder / ROOM).write_text(room.to_toml(), encoding="utf-8")
        name = ROOM
    said = {key: value for key, value in options.items() if isinstance(value, int | float | str)}
    command = [
        *words,
        "--arena",
        name,
        *(word for key, value in said.items() for word in (f"--{key}", str(value))),
    ]
    about = {
        "command": shlex.join(["cogmap", *command]),
        "different": {key: repr(value) for key, value in options.items() if key not in said},
        "versions": versions(),
    }
    (folder / ABOUT).write_text(json.dumps(about, indent=2) + "\n", encoding="utf-8")


def versions() -> Mapping[str, str]:
    """Tell the versions of Python and of the packages that figures depend on."""
    return {"python": platform.python_version(), **{package: _version(package) for package in PACKAGES}}


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"
