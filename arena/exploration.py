"""Explore: a body walks through a room, looks and smells."""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from threading import Event
from typing import Any, cast

import numba
import numpy as np
from tqdm import tqdm

from arena.acting import DT, act_and_look
from arena.bodies.base import Body, Configurations, joints_of
from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.explorers import Explorers
from arena.eye.base import AnyEye, see
from arena.eye.camera import Camera, Images
from arena.motions.base import Motion, MovesAnyBody, Striding, Walk, join
from arena.motions.policy import Policy
from arena.paths import user_path
from arena.recordings import storage
from arena.recordings.origin import origin, unlike
from arena.recordings.recording import Recording
from arena.recordings.resuming import refuse_another
from arena.recordings.sharding import shards, write_shard
from arena.rooms.arena import Arena
from arena.settings import AnyArray, Whole, checked_whole
from arena.smell.nose import Nose
from arena.steered import of_one, write_down


def explore(
    arena: Arena,
    motion: Motion | Policy,
    camera: AnyEye,
    *,
    nose: Nose = Nose(),
    body: Body = Disc(),
    views: Whole | None = None,
    seed: Whole = 0,
    start: AnyArray | None = None,
    dt: float | None = None,
    out: str | Path | None = None,
    progress: bool = False,
) -> Recording:
    """Move through the room, and record what is seen and smelt on the way.

    A `Motion` goes its way whatever it meets: as many threads as numba may use paint what a `Camera` sees, in
    memory while the body walks on, if its motion is `Striding`. Their number changes nothing. A `Policy` is
    shown every view, and asked what to do until the next; the recording has its `commands`.

    Parameters
    ----------
    arena, motion, camera, nose, body
        The room, how to move, and the animal. The recording of a body with joints has them, for scoring.
    views
        How many to take; None takes what the motion does by default, or all until the policy stops.
    seed
        Varies the walk, slip and the noise of the nose and the camera, never the room.
    start, dt
        Of a policy: where the body starts on its axes, drawn from what is free when None, and the time from a
        view to the next, s, 0.2 when None. A motion has its own.
    out
        Folder to stream to, 256 views at a time. The same call after a kill goes on where it stopped and ends
        with the same bits, on every x86-64 processor with AVX2 and the same versions (a `Chemotaxis` only in
        portable arithmetic: its way hangs on the last digit of a smell); a recording that is whole is only
        opened. What a policy remembers dies with it: after a kill it starts over, and only where there is no
        recording yet. None keeps all in memory.
    progress
        Whether to show a bar on stderr.

    Raises
    ------
    ArenaError
        For a count or seed out of range, a body that does not fit, commands that mean nothing, or an `out`
        that holds something else.
    """
    seed = checked_whole("seed", seed)
    views = None if views is None else checked_whole("views", views, 1)
    parts = {"camera": camera, "nose": nose, "body": body}
    told = {"arena": arena.to_toml(), "seed": seed, **_described(parts)}
    path = None if out is None else user_path(out)
    if not isinstance(motion, Motion):
        dt = DT if dt is None else float(dt)
        start = None if start is None else tuple(np.asarray(start, float).tolist())
        name = getattr(motion, "__name__", type(motion).__name__)
        told |= {"motion": {"kind": name, "start": start, "dt": dt}, "walk": {}, "origin": origin()}
        rng = np.random.default_rng(np.random.SeedSequence(seed).spawn(1)[0])
        one = Explorers(arena, camera, nose=nose, body=body, count=1)
        begin = tuple(body.sample_free(arena, 1, rng)[0].tolist()) if start is None else start
        one.begin(np.zeros(1, int), [begin], [rng])
        steps = islice(act_and_look(one, of_one(motion, len(body.motors)), dt), views)
        counted = tqdm(steps, total=views, unit="view", disable=not progress)
        return write_down(iter(counted), dt, path, (camera.height, camera.width, 3), told, body=body)
    if start is not None or dt is not None:
        raise ArenaError(f"start and dt are of a policy; {type(motion).__name__} has its own")
    views = motion.default_views if views is None else views
    attributes = told | _described({"motion": motion}) | {"views": views}
    begun = None if path is None else _begun(path, attributes)
    if path is not None and begun is not None and not begun.missing:
        return Recording.open(path)
    walk_rng, nose_rng = (np.random.default_rng(child) for child in np.random.SeedSequence(seed).spawn(2))
    crew = _Crew(arena, camera, body, seed, progress)
    if path is None and views is not None and isinstance(motion, Striding) and isinstance(body, Disc):
        strides = motion.strides(arena, body, views, walk_rng)
    else:
        walk = _walk(motion, arena, body, views, walk_rng)
        strides, views = iter([walk]), len(walk.times)
    if path is None:
        walk, images = crew.see(strides, views)
    poses = body.camera_poses(walk.poses)
    columns: dict[str, Any] = {
        "times": walk.times,
        "odours": nose.smell(arena.odours.concentration(poses[:, :2]), walk.times, nose_rng),
        "poses": poses,
        "commands": walk.commands,
        "joints": joints_of(body, walk.poses),
    }
    columns = {name: values for name, values in columns.items() if values is not None}
    attributes |= {"walk": dict(walk.notes), "origin": origin()}
    if path is None:
        return Recording(views=images, **columns, attributes=attributes)
    if begun is None:
        with storage.new_folder(path, (views, camera.height, camera.width, 3), columns, attributes):
            pass  # It has its name from here on, and the views follow: a kill loses what is being made.
    else:
        _check_columns(path, begun, columns)
    try:
        crew.record(walk.poses, path / "views", shards(views) if begun is None else begun.missing)
    except OSError as error:
        raise ArenaError(
            f"cannot write {path}: {error.strerror or error}; what is written is kept, and the same command "
            "goes on from there"
        ) from None
    return Recording.open(path)


def _walk(motion: Motion, arena: Arena, body: Body, views: int | None, rng: np.random.Generator) -> Walk:
    """Let a motion move a body, if it can."""
    if isinstance(body, Disc):
        return motion.walk(arena, body, views, rng)
    if isinstance(motion, MovesAnyBody):
        return cast("MovesAnyBody", motion).walk(arena, body, views, rng)
    raise ArenaError(
        f"{type(motion).__name__} steers a disc, and this body is of kind {type(body).__name__}; "
        "let it babble, replay a path or go by a policy"
    )


def _described(parts: Mapping[str, Any]) -> dict[str, Any]:
    """Describe the parts of an exploration as they will read back from JSON, where tuples are lists."""
    described = {name: {"kind": type(part).__name__, **part.model_dump()} for name, part in parts.items()}
    read_back: dict[str, Any] = json.loads(json.dumps(described))
    return read_back


def _begun(path: Path, wanted: dict[str, Any]) -> storage.Stored | None:
    """Open what is there already, which must have these attributes."""
    if not path.exists():
        return None
    begun = storage.load(path)
    refuse_another(path, begun.attributes, wanted)
    return begun


def _check_columns(path: Path, begun: storage.Stored, wanted: dict[str, np.ndarray]) -> None:
    """Refuse to go on with what was seen elsewhere: half of the views would not belong to the poses."""
    found = begun.columns
    if found.keys() != wanted.keys() or not all(np.array_equal(found[name], wanted[name]) for name in wanted):
        there = unlike(begun.attributes.get("origin", {})) or "another version of this program"
        raise ArenaError(
            f"{path} was begun by what walks or smells otherwise: {there}; go on with it where it was begun, "
            "or remove it and start again"
        )


@dataclass(frozen=True)
class _Crew:
    """Those who paint: threads of which each takes a shard. A shard has noise of its own, and comes alone."""

    arena: Arena
    camera: AnyEye
    body: Body
    seed: int
    progress: bool

    def see(self, strides: Iterable[Walk], views: int) -> tuple[Walk, Images]:
        """Paint what is seen on a walk while it goes on."""
        images = np.empty((views, self.camera.height, self.camera.width, 3), np.uint8)
        way = np.empty((views, len(self.body.axes)))
        waiting, taken, there = shards(views), list[Walk](), 0

        def paint(rows: slice, rng: np.random.Generator) -> None:
            see(self.camera, self.arena, self.body, way[rows], out=images[rows], rng=rng)

        with self._at_work(paint, views) as give:
            for stride in strides:
                taken.append(stride)
                way[there : there + len(stride.poses)] = stride.poses
                there += len(stride.poses)
                while waiting and waiting[0].stop <= there:
                    give(waiting.pop(0))
        return join(taken), images

    def record(self, way: Configurations, folder: Path, missing: list[slice]) -> None:
        """Paint what is missing of an array on disk."""

        def paint(rows: slice, rng: np.random.Generator) -> None:
            images = np.empty((rows.stop - rows.start, self.camera.height, self.camera.width, 3), np.uint8)
            see(self.camera, self.arena, self.body, way[rows], out=images, rng=rng)
            write_shard(folder, rows, images)

        with self._at_work(paint, len(way)) as give:
            for rows in missing:
                give(rows)

    @contextmanager
    def _at_work(
        self, paint: Callable[[slice, np.random.Generator], None], views: int
    ) -> Iterator[Callable[[slice], object]]:
        given, failed = list[tuple[int, Future[None]]](), Event()

        def work(rows: slice) -> None:
            if failed.is_set():
                return
            rng = np.random.default_rng(np.random.SeedSequence(self.seed, spawn_key=(2, rows.start)))
            try:
                paint(rows, rng)
            except BaseException:
                failed.set()
                raise

        # Of other eyes nobody knows whether they can look from several threads at once.
        threads = numba.get_num_threads() if isinstance(self.camera, Camera) else 1
        # One thread of numba to each, as its own are for one caller at a time.
        pool = ThreadPoolExecutor(threads, initializer=numba.set_num_threads, initargs=(1,))
        try:
            yield lambda rows: given.append((rows.stop - rows.start, pool.submit(work, rows)))
            with tqdm(total=views, unit="view", disable=not self.progress) as bar:
                bar.update(views - sum(count for count, _ in given))
                for count, future in given:
                    future.result()
                    bar.update(count)
        finally:
            failed.set()
            pool.shutdown(cancel_futures=True)
