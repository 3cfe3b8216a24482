"""Explore: a body walks through a room, looks and smells."""

import json
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, UInt8
from tqdm import tqdm

from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.motions.base import Motion
from arena.recordings import storage
from arena.recordings.origin import origin, unlike
from arena.recordings.recording import Recording
from arena.recordings.sharding import shards, write_shards
from arena.rooms.arena import Arena
from arena.smell.nose import Nose


@runtime_checkable
class Eye(Protocol):
    """What sees: an `arena.eye.camera.Camera`, or anything that renders like it."""

    @property
    def height(self) -> int:
        """Rows of an image."""

    @property
    def width(self) -> int:
        """Columns of an image."""

    def render(
        self, arena: Arena, poses: Float[np.ndarray, "views 3"], *, rng: np.random.Generator
    ) -> UInt8[np.ndarray, "views height width 3"]:
        """Paint the views from poses, with what sensor noise there is from the generator."""

    def model_dump(self) -> dict[str, Any]:
        """Give the parameters that, with the arena, determine every pixel."""


def explore(
    arena: Arena,
    motion: Motion,
    camera: Eye,
    *,
    nose: Nose = Nose(),
    body: Disc = Disc(),
    views: int | None = None,
    seed: int = 0,
    out: str | Path | None = None,
    progress: bool = False,
) -> Recording:
    """Walk through the room, and record what is seen and smelt on the way.

    Parameters
    ----------
    arena, motion, camera, nose, body
        The room, how to move, and the animal.
    views
        How many to take; None takes what the motion does by default.
    seed
        Varies the walk and the noise of the nose and the camera, never the room.
    out
        Folder to stream to, 256 views at a time. The same call after a kill goes on where it stopped and ends
        with the same bits, on every x86-64 processor with AVX2 and the same versions (a `Chemotaxis` only in
        portable arithmetic: its way hangs on the last digit of a smell); a recording that is whole is only
        opened. None keeps all in memory.
    progress
        Whether to show a bar on stderr.

    Raises
    ------
    ArenaError
        For a count or seed out of range, a body that does not fit, or an `out` that holds something else.
    """
    if views is None:
        views = motion.default_views
    if (views is not None and views < 1) or seed < 0:
        raise ArenaError(f"views is {views} and seed is {seed}; give at least one view and no negative seed")
    parts: dict[str, Any] = {"camera": camera, "motion": motion, "nose": nose, "body": body}
    described = {name: {"kind": type(part).__name__, **part.model_dump()} for name, part in parts.items()}
    # As it will read back from JSON, where tuples are lists.
    described = json.loads(json.dumps(described))
    attributes = {"arena": arena.to_toml(), **described, "views": views, "seed": seed}
    path = None if out is None else Path(out)
    begun = None if path is None else _begun(path, attributes)
    if path is not None and begun is not None and not begun.missing:
        return Recording.open(path)
    walk_rng, nose_rng = (np.random.default_rng(child) for child in np.random.SeedSequence(seed).spawn(2))
    walk = motion.walk(arena, body, views, walk_rng)
    columns: dict[str, Any] = {
        "times": walk.times,
        "odours": nose.smell(arena.odours.concentration(walk.poses[:, :2]), walk.times, nose_rng),
        "poses": walk.poses,
    }
    attributes |= {"walk": dict(walk.notes), "origin": origin()}
    shape = (len(walk.times), camera.height, camera.width, 3)
    look = partial(_look, arena, camera, walk.poses, seed=seed, progress=progress)
    if path is None:
        images = np.empty(shape, np.uint8)
        for rows, seen in look(shards(len(images))):
            images[rows] = seen
        return Recording(views=images, **columns, attributes=attributes)
    missing = shards(len(walk.times)) if begun is None else begun.missing
    if begun is None:
        with storage.new_folder(path, shape, columns, attributes):
            pass  # It has its name from here on, and the views follow: a kill loses one shard at most.
    else:
        _check_columns(path, begun, columns)
    try:
        write_shards(path / "views", look(missing))
    except OSError as error:
        raise ArenaError(
            f"cannot write {path}: {error.strerror or error}; what is written is kept, and the same command "
            "goes on from there"
        ) from None
    return Recording.open(path)


def _begun(path: Path, wanted: dict[str, Any]) -> storage.Stored | None:
    """Open what is there already, which must have these attributes."""
    if not path.exists():
        return None
    begun = storage.load(path)
    differing = [key for key in wanted if begun.attributes.get(key) != wanted[key]]
    if differing:
        raise ArenaError(
            f"{path} holds another recording, of a different {' and '.join(differing)}; "
            "choose another path or remove it first"
        )
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


def _look(
    arena: Arena,
    camera: Eye,
    poses: Float[np.ndarray, "views 3"],
    missing: list[slice],
    *,
    seed: int,
    progress: bool,
) -> Iterator[tuple[slice, UInt8[np.ndarray, "shard height width 3"]]]:
    """Paint the missing views; each shard has noise of its own, so that it can be made again alone."""
    with tqdm(total=len(poses), unit="view", disable=not progress) as bar:
        bar.update(len(poses) - sum(rows.stop - rows.start for rows in missing))
        for rows in missing:
            rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(2, rows.start)))
            yield rows, camera.render(arena, poses[rows], rng=rng)
            bar.update(rows.stop - rows.start)
