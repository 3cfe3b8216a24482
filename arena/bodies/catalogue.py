"""Bodies by their names, found by themselves."""

from collections.abc import Callable
from functools import cache

from arena.bodies.disc import Disc
from arena.registry import named_by_file, settings_with


@cache
def bodies() -> dict[str, Callable[..., Disc]]:
    """Find the settings that have `place`, each by the name of its file: `Disc` is `disc`."""
    return named_by_file("arena.bodies", settings_with("place"))
