"""Types at each step of a walk are checked where walks are tested: elsewhere it takes longer than walking."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

STEPPING = ("arena.angles", "arena.bodies.", "arena.motions.")


@cache
def _stepping() -> tuple[Callable[..., Any], ...]:
    from arena.bodies.catalogue import bodies  # noqa: PLC0415  imported once type checks are hooked in
    from arena.motions.catalogue import motions  # noqa: PLC0415

    bodies(), motions()
    modules = [module for name, module in sys.modules.items() if name.startswith(STEPPING)]
    return tuple(part for module in modules for part in _functions(module))


def _functions(module: Any) -> Iterator[Callable[..., Any]]:
    classes = [part for part in vars(module).values() if inspect.isclass(part)]
    for holder in (module, *(kind for kind in classes if kind.__module__ == module.__name__)):
        for part in vars(holder).values():
            function = getattr(part, "fget", None) or getattr(part, "__func__", part)
            if inspect.isfunction(function):
                yield function


def check_steps(*, checked: bool) -> None:
    """Have the types of all that moves a body checked at each call, or not."""
    for function in _stepping():
        function.__no_type_check__ = not checked  # type: ignore[attr-defined]
