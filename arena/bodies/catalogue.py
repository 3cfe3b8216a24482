"""Bodies by their names, found by themselves."""

from collections.abc import Callable
from functools import cache

from arena.bodies.base import Body
from arena.registry import named_by_file, settings_with


@cache
def bodies() -> dict[str, Callable[..., Body]]:
    """Find the settings that have `at_large`, each by the name of its file: `Disc` is `disc`."""
    return named_by_file("arena.bodies", settings_with("at_large"))
