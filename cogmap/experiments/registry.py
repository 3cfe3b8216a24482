"""The registry of experiments, and how to run one by its name."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from contextlib import nullcontext
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple, TypeVar

from arena import Arena
from arena.registry import modules_of
from cogmap.atomic import result_folder, user_path
from cogmap.errors import CogmapError
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.provenance import write_provenance
from cogmap.experiments.result import Result
from cogmap.inputs import Whole, check_choice, checked_count

FEWEST = 200
"""Views that every experiment can do with, if not well."""


Run = TypeVar("Run", bound=Callable[..., Result])


class Experiment(NamedTuple):
    """What is done, and where and how much of it unless told."""

    run: Callable[[Conditions], Result]
    room: str
    views: int
    any_room: bool = True
    """Whether it can be done in other rooms."""
    takes: tuple[str, ...] = ()
    """Which of `nose`, `motion`, `camera`, `body` and `map` may differ from its own."""
    extra_rooms: tuple[str, ...] = ()
    """Rooms that it visits as well, unless told where to take place."""
    body: str = "disc"
    """Name of its own body, of which fields alone may be told."""

    @property
    def summary(self) -> str:
        """What it does: the first line of its docstring."""
        return (inspect.getdoc(self.run) or "").partition("\n")[0]

    @property
    def family(self) -> str:
        """What experiments like it are about: the first line of the docstring of their package."""
        package = self.run.__module__.rpartition(".")[0] or self.run.__module__
        words = getattr(sys.modules.get(package), "__doc__", None) or package
        return words.partition("\n")[0].removesuffix(", one file each.")


_registered: dict[str, Experiment] = {}


def experiment(
    *,
    room: str,
    views: int,
    any_room: bool = True,
    takes: tuple[str, ...] = (),
    extra_rooms: tuple[str, ...] = (),
    body: str = "disc",
) -> Callable[[Run], Run]:
    """Register a function as the experiment of its name; the parameters are those of `Experiment`.

    Raises
    ------
    CogmapError
        When another module has an experiment of this name.
    """

    def register(run: Run) -> Run:
        known = _registered.get(run.__name__)
        if known is not None and known.run.__module__ != run.__module__:
            raise CogmapError(
                f"there is an experiment {run.__name__!r} in {known.run.__module__} already; "
                f"rename that of {run.__module__}"
            )
        _registered[run.__name__] = Experiment(run, room, views, any_room, takes, extra_rooms, body)
        return run

    return register


@cache
def experiments() -> dict[str, Experiment]:
    """Find all experiments: those of the packages here and of the plugins of `cogmap.experiments`."""
    # The decorator registers each when its file is imported.
    list(modules_of("cogmap.experiments"))
    return _registered


def listing() -> list[dict[str, str]]:
    """Tell what each experiment is called, does, takes and where it takes place, those of a kind together."""
    return [
        {
            "experiment": name,
            "what it does": chosen.summary,
            "about": chosen.family,
            "room": ", ".join((chosen.room, *chosen.extra_rooms)),
            "views": f"{chosen.views:,}",
            "takes": ", ".join((*(["arena"] if chosen.any_room else []), *chosen.takes)),
        }
        for name, chosen in sorted(experiments().items(), key=lambda item: (item[1].family, item[0]))
    ]


def run_experiment(
    name: str,
    out: str | Path | None = None,
    *,
    room: Arena | None = None,
    views: Whole | None = None,
    seed: Whole = 0,
    progress: bool = False,
    library: str | Path | None = None,
    **overrides: Any,
) -> Result:
    """Run an experiment by its name.

    Parameters
    ----------
    name
        One of `experiments()`.
    out
        Folder for `metrics.json`, figures and the data behind them; an earlier result there is replaced at
        the end. None writes nothing.
    room
        Where; the room or rooms that the experiment was made for when None.
    views
        To learn from; as many as the figures of the paper need when None.
    seed
        Of walks, noise and all that is drawn.
    progress
        Whether to show progress on stderr.
    library
        Folder, which must exist, in which walks are looked for and left for other runs; None leaves none.
    overrides
        `nose`, `motion`, `camera`, `body`, or parameters of `CognitiveMap` as `map`, where it takes them.

    Raises
    ------
    ArenaError, CogmapError
        For an unknown name, a room or counts that cannot work, something that the experiment does not take, a
        folder that holds something else.
    """
    check_choice("experiment", name, tuple(sorted(experiments())))
    chosen = experiments()[name]
    if room is not None and not chosen.any_room:
        raise CogmapError(f"{name} takes place in rooms of its own, not in {room.name!r}; leave the room out")
    for what in overrides:
        if what not in chosen.takes:
            takes = ", ".join(chosen.takes) or "nothing but room, views and seed"
            raise CogmapError(f"{name} does not take another {what}; it takes {takes}")
    seed, library = checked_count("seed", seed, 0), None if library is None else user_path(library)
    views = chosen.views if views is None else checked_count("views", views, FEWEST)
    names = (chosen.room, *chosen.extra_rooms)
    room, *extra_rooms = [Arena.load(name) for name in names] if room is None else [room]
    with (
        nullcontext() if out is None else result_folder(out) as folder,
        TemporaryDirectory(prefix="cogmap-") as scratch,
    ):
        conditions = Conditions(
            room, views, seed, progress, Path(scratch), library, extra_rooms=tuple(extra_rooms), **overrides
        )
        about = {
            "experiment": name,
            "arena": ", ".join(item.name for item in (room, *extra_rooms)),
            "views": views,
            "seed": seed,
        }
        result = chosen.run(conditions).described(about)
        if folder is not None:
            result.write(folder)
            where = room if chosen.any_room else None
            write_provenance(folder, ("experiment", name), where, views=views, seed=seed, **overrides)
    return result
