"""Grow one map of what many explorers see: some stages by one thread, most of the work by all."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

from arena.atomic import check_absent
from arena.bodies.base import Body
from arena.bodies.disc import Disc
from arena.eye.base import AnyEye
from arena.eye.camera import Camera
from arena.motions.base import Motion
from arena.motions.brownian import Brownian
from arena.rooms.arena import Arena
from arena.smell.nose import Nose
from cogmap.atomic import user_path
from cogmap.crew import Wording, on_cluster
from cogmap.errors import CogmapError
from cogmap.growing.checkpoint import KEPT, Checkpoint
from cogmap.growing.expedition import Expedition
from cogmap.growing.growth import Crew, Growth
from cogmap.growing.progress import Progress
from cogmap.growing.work import Outcome, Task, do
from cogmap.inputs import Whole, checked_count
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.threads import in_order, one_thread

EPOCH = 50_000
"""Views of an epoch in the stages that one thread learns, unless there are fewer."""
MOST_CHARTS = 6_000
"""Charts of a map of a million views, unless told."""
CREW = Wording("a share of the explorers", KEPT)
"""How a crew speaks of what it does."""


def grow(
    room: Arena | str | Path,
    out: str | Path,
    *,
    explorers: Whole = 64,
    views: Whole = 1_000_000,
    charts: Whole | None = None,
    epoch: Whole | None = None,
    motion: Motion = Brownian(),
    camera: AnyEye = Camera.panoramic(),
    nose: Nose = Nose(),
    body: Body = Disc(),
    seed: Whole = 0,
    threads: Whole | None = None,
    scheduler: str | None = None,
    progress: bool = False,
    **parameters: Any,
) -> CognitiveMap:
    """Grow one map of what many explorers see and smell in a room, and save it; nothing else is kept.

    Code, charts and cells compete for views, and are learnt by one thread, from views picked by chance from
    all walks, for so many epochs as the stages have. All views of all explorers are then summed up in those
    stages that learn sums: what charts know of smell, the metric map, twice, and the afferents. Threads do
    this for shares of the explorers on forks of the map, which are merged in the order of the shares.

    The map is the same bit by bit whatever the number of threads, on one machine and on a cluster whose
    workers calculate alike; where they do not, a warning says so. After a kill the same call goes on, from
    what lies in a folder beside the map until it is whole.

    Parameters
    ----------
    room
        A room, the name of one in the gallery, or the path of a TOML file.
    out
        Folder of the map; it must not exist. With a scheduler, all workers must see it by this path.
    explorers, views
        How many, and how many views of all of them together.
    charts
        Of the map; a third of the views when None, and `MOST_CHARTS` at most.
    epoch
        Views of an epoch where one thread learns; `EPOCH` when None, or all when there are fewer.
    motion, camera, nose, body
        The animal, and how it moves.
    seed
        Varies walks, noses, initial weights and the order of views, never the room.
    threads
        How many on this machine; as many as cores when None.
    scheduler
        Address of a Dask scheduler, whose workers do the shares instead; they may come and go.
    progress
        Whether to show a bar with the time left on stderr.
    **parameters
        Any other of `CognitiveMap`.

    Raises
    ------
    ArenaError, CogmapError
        For what cannot be, before anything is done; an `out` that exists, or where another map grows; a
        scheduler that does not answer, or whose workers are killed over one share.
    """
    explorers, views = checked_count("explorers", explorers), checked_count("views", views)
    threads = None if threads is None else checked_count("threads", threads)
    if threads is not None and scheduler is not None:
        raise CogmapError(
            "threads are those of this machine, and a scheduler has its workers; give one of them"
        )
    if views < explorers:
        raise CogmapError(f"there are {views} views for {explorers} explorers; give each one at least")
    if not isinstance(body, Disc):
        raise CogmapError(f"the body is of kind {type(body).__name__}; many explorers are discs")
    charts = usual_charts(views) if charts is None else checked_count("charts", charts)
    if views < charts:
        raise CogmapError(
            f"there are {views} views for {charts} charts; take more views or use fewer charts: "
            "at most a third as many as views"
        )
    epoch = min(views, EPOCH) if epoch is None else checked_count("epoch", epoch)
    if epoch > views:
        raise CogmapError(f"an epoch is {epoch} views and there are {views}; give at most all of them")
    room = room if isinstance(room, Arena) else Arena.load(room)
    seed = checked_count("seed", seed, 0)
    expedition = Expedition(room.to_toml(), motion, camera, nose, body, explorers, views, seed)
    blank = CognitiveMap(charts=charts, epoch=epoch, seed=seed, **parameters)
    path = user_path(out).resolve()
    checkpoint = Checkpoint.beside(path)
    if not checkpoint.folder.exists():
        check_absent(path, CogmapError)
    crew: Crew = (
        partial(in_threads, threads=threads)
        if scheduler is None
        else partial(on_cluster, do, address=scheduler, wording=CREW)
    )
    settings = blank.get_params()
    del settings["device"]
    with checkpoint.opened({**expedition.described(), "map": settings}):
        if path.exists():  # killed when all was done
            return CognitiveMap.load(path)
        with closing(Progress(disable=not progress)) as bar:
            grown = Growth(expedition, checkpoint, crew, bar).run(blank)
        grown.save(path)
    return grown


def in_threads(tasks: Iterable[Task], *, threads: int | None) -> Iterator[Outcome]:
    """Do tasks in threads of this process: its libraries and the map are there once for all."""
    # said before threads begin, as each would set what is one for all of them
    with one_thread():
        yield from in_order(do, tasks, threads)


def usual_charts(views: int) -> int:
    """Count the charts of a map that many explorers grow."""
    return max(1, min(MOST_CHARTS, views // 3))
