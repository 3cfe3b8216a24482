"""Registry: things of one kind, one file each, found by themselves in a package and its plugins."""

import inspect
import pkgutil
from collections.abc import Callable, Iterator
from importlib import import_module
from importlib.metadata import entry_points
from types import ModuleType
from typing import Any, TypeVar

from arena.errors import ArenaError
from arena.settings import Settings

T = TypeVar("T")


def modules_of(package: str) -> Iterator[ModuleType]:
    """Import every module of a package, and of the plugins for it.

    A plugin is a module or a package that an installed distribution names by an entry point, in the group
    that is called as the package: `[project.entry-points."arena.motions"]`.

    Raises
    ------
    ArenaError
        For a plugin that cannot be imported.
    """
    yield from _with_all_inside(import_module(package))
    for point in entry_points(group=package):
        try:
            yield from _with_all_inside(point.load())
        except ImportError as error:
            raise ArenaError(f"the plugin {point.value!r} of {package} cannot be imported: {error}") from None


def named_by_file(package: str, pick: Callable[[ModuleType], T | None]) -> dict[str, T]:
    """Register what is picked from the modules of a package, by the names of their files.

    Raises
    ------
    ArenaError
        When two have the same name, and as `modules_of`.
    """
    found: dict[str, T] = {}
    for module in modules_of(package):
        name, thing = module.__name__.rpartition(".")[2], pick(module)
        if thing is not None and found.setdefault(name, thing) is not thing:
            raise ArenaError(f"two files of {package} are called {name}; {module.__file__} is the second")
    return dict(sorted(found.items()))


def settings_with(method: str) -> Callable[[ModuleType], Callable[..., Any] | None]:
    """Pick the settings that a module defines itself, with no method left open, and that have this one."""

    def pick(module: ModuleType) -> Callable[..., Any] | None:
        kinds = (value for value in vars(module).values() if isinstance(value, type))
        mine = (kind for kind in kinds if issubclass(kind, Settings) and kind.__module__ == module.__name__)
        return next((kind for kind in mine if hasattr(kind, method) and not inspect.isabstract(kind)), None)

    return pick


def _with_all_inside(module: ModuleType) -> Iterator[ModuleType]:
    yield module
    for found in pkgutil.iter_modules(getattr(module, "__path__", ()), f"{module.__name__}."):
        yield from _with_all_inside(import_module(found.name))
