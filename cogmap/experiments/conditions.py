"""Conditions of an experiment: where it takes place, and how much of it there is."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from filelock import FileLock

from arena import Arena, Body, Disc, Motion, Nose, Recording, explore
from arena.eye.base import AnyEye

FRESH_SEED = 1000
"""Added to the seed for a fresh walk, on which what was learnt is scored."""


@dataclass(frozen=True)
class Conditions:
    """What every experiment is told."""

    room: Arena
    views: int
    """To learn from."""
    seed: int = 0
    """Of walks, noise and all that is drawn."""
    progress: bool = False
    """Whether to show progress on stderr."""
    scratch: Path | None = None
    """Folder to keep views in while the experiment lasts; in memory when None."""
    library: Path | None = None
    """Folder to keep views in for all who take the same walk, in this process or another."""
    nose: Nose = field(default_factory=Nose)
    """To smell with."""
    motion: Motion | None = None
    """Way to move; the experiment's own when None."""
    camera: AnyEye | None = None
    """To look through; the experiment's own when None."""
    body: Body | None = None
    """To move; the experiment's own when None."""
    map: Mapping[str, Any] = field(default_factory=dict)
    """Parameters of `CognitiveMap` that differ from the experiment's own."""
    extra_rooms: tuple[Arena, ...] = ()
    """Rooms to visit after the first, by an experiment of several."""

    def explore(
        self,
        motion: Motion,
        camera: AnyEye,
        *,
        body: Body | None = None,
        views: int | None = None,
        fresh: bool = False,
    ) -> Recording:
        """Walk through the room, by `motion`, `camera` and `body` where the conditions have none of its own.

        A fresh walk is another, of 5,000 views, or of as many as are learnt from when these are fewer. The
        walk is the same whatever the camera. From a library, it is taken once: who else wants it waits.
        """
        way, eye, body = self.motion or motion, self.camera or camera, self.body or body or Disc()
        if views is None:
            views = min(5000, self.views) if fresh else self.views
        seed = self.seed + FRESH_SEED * fresh
        walk = partial(explore, self.room, way, eye, body=body, nose=self.nose, views=views, seed=seed)
        if self.library is None:
            out = None if self.scratch is None else Path(mkdtemp(dir=self.scratch)) / "walk.zarr"
            return walk(out=out, progress=self.progress)
        described = repr((self.room, way, eye, body, self.nose, views, seed))
        shelf = self.library / hashlib.sha256(described.encode()).hexdigest()[:32]
        with FileLock(shelf.with_suffix(".lock")):
            return walk(out=shelf.with_suffix(".zarr"), progress=self.progress)
