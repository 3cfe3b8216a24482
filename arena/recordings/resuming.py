"""Resuming: whether what was begun is what is wanted now."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from arena.errors import ArenaError


def refuse_another(path: Path, begun: Mapping[str, Any], wanted: Mapping[str, Any]) -> None:
    """Raise an `ArenaError` unless what was begun at a path has these attributes."""
    differing = [key for key in wanted if begun.get(key) != wanted[key]]
    if differing:
        raise ArenaError(
            f"{path} holds another recording, of a different {' and '.join(differing)}; "
            "choose another path or remove it first"
        )
