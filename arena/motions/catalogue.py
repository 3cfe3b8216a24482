"""Motions by their names, found by themselves."""

from collections.abc import Callable
from functools import cache

from arena.motions.base import Motion
from arena.registry import named_by_file, settings_with


@cache
def motions() -> dict[str, Callable[..., Motion]]:
    """Find the settings that have `walk`, each by the name of its file: `Brownian` is `brownian`."""
    return named_by_file("arena.motions", settings_with("walk"))
