"""The expedition: many explorers in one room, what each sees and smells, and who is dealt with together."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from arena import Arena, Disc, Nose
from arena.eye.base import AnyEye, see
from arena.motions.base import Motion
from cogmap.errors import CogmapError
from cogmap.inputs import log_odours

TOGETHER, LEAST_SHARES = 16_384, 16
"""Views of a share at most, some seconds of work and 4 MB of codes, unless one explorer sees more; and into
how many shares all are divided at least, so that there is work for several threads."""
CODING, PAINTING = 2, 3
"""What the noise of an eye is drawn for: views on a way, and views picked from all ways."""


class Way(NamedTuple):
    """What there is to know of an explorer: the truth, from which its views are painted, and its smells."""

    poses: Float[np.ndarray, "views axes"]
    """On the axes of its body; nothing that learns is told them."""
    log_odours: Float[np.ndarray, "views odorants"]


class Share(NamedTuple):
    """Explorers that are dealt with together: those from `first` to before `end`."""

    first: int
    end: int
    rows: slice
    """Their views, among those of all."""


@dataclass(frozen=True)
class Expedition:
    """Explorers of one kind in a room, each on a walk of its own.

    Explorer k draws from the k-th generator that the seed spawns, whoever walks beside it; shares depend on
    the numbers of explorers and views alone. So whoever does them, all of it is the same bit by bit.

    Parameters
    ----------
    room
        TOML of the room: a room itself is long to send, with all it has worked out.
    motion, camera, nose, body
        The animal, and how it moves.
    explorers, views
        How many, and how many views of all of them together; each has as many as any other, but for one.
    seed
        Of walks and noses.
    """

    room: str
    motion: Motion
    camera: AnyEye
    nose: Nose
    body: Disc
    explorers: int
    views: int
    seed: int

    @cached_property
    def ends(self) -> list[int]:
        """How many views there are up to each explorer's last."""
        each, over = divmod(self.views, self.explorers)
        return list(accumulate(each + (k < over) for k in range(self.explorers)))

    def rows(self, explorer: int) -> slice:
        """Give the views of an explorer, among those of all."""
        return slice(self.ends[explorer - 1] if explorer else 0, self.ends[explorer])

    @cached_property
    def shares(self) -> list[Share]:
        """Explorers in turn, as many as have few enough views together, but one at least."""
        shares, first, most = list[Share](), 0, min(TOGETHER, self.views // LEAST_SHARES)
        for end in range(1, self.explorers + 1):
            begin = self.rows(first).start
            if end == self.explorers or self.ends[end] - begin > most:
                shares.append(Share(first, end, slice(begin, self.ends[end - 1])))
                first = end
        return shares

    def walk(self, explorer: int) -> Way:
        """Let an explorer walk, and smell on its way.

        Raises
        ------
        CogmapError
            Where its motion gives it another number of views.
        """
        room, rows = parsed(self.room), self.rows(explorer)
        walk_rng, nose_rng = (np.random.default_rng(child) for child in self.chance(explorer).spawn(2))
        walk = self.motion.walk(room, self.body, rows.stop - rows.start, walk_rng)
        if len(walk.times) != rows.stop - rows.start:
            raise CogmapError(
                f"explorer {explorer} is to take {rows.stop - rows.start} views and its motion gives "
                f"{len(walk.times)}; choose another number of views or explorers, or another motion"
            )
        poses = self.body.camera_poses(walk.poses)
        smelt = self.nose.smell(room.odours.concentration(poses[:, :2]), walk.times, nose_rng)
        return Way(walk.poses, log_odours(smelt) if smelt.shape[1] else smelt)

    def views_on(self, explorer: int, poses: Float[np.ndarray, "views axes"]) -> Painted:
        """Give what an explorer sees on its way, painted when it is asked for."""
        return Painted(self, poses, (explorer, CODING))

    def views_from(self, poses: Float[np.ndarray, "views axes"], draw: int) -> Painted:
        """Give what is seen from poses of any explorers; `draw` varies the noise of the eye."""
        return Painted(self, poses, (draw, PAINTING))

    def described(self) -> dict[str, Any]:
        """Describe it as it will read back from JSON."""
        parts = {"motion": self.motion, "camera": self.camera, "nose": self.nose, "body": self.body}
        told = {name: {"kind": type(part).__name__, **part.model_dump()} for name, part in parts.items()}
        counts = {"explorers": self.explorers, "views": self.views, "seed": self.seed}
        text = json.dumps({"arena": self.room, **told, **counts}, default=str)
        described: dict[str, Any] = json.loads(text)
        return described

    def chance(self, *key: int) -> np.random.SeedSequence:
        """Give the seeds that belong to a key."""
        return np.random.SeedSequence(self.seed, spawn_key=key)


class Painted:
    """Views from poses, painted when slices are asked for and kept nowhere."""

    dtype = np.dtype(np.uint8)

    def __init__(
        self, expedition: Expedition, poses: Float[np.ndarray, "views axes"], key: tuple[int, ...]
    ) -> None:
        camera = expedition.camera
        self._expedition, self._poses, self._key = expedition, poses, key
        self.shape = (len(poses), camera.height, camera.width, 3)

    def __len__(self) -> int:
        return len(self._poses)

    def __getitem__(self, rows: slice) -> np.ndarray:
        """Paint some of them; the noise of the eye goes by the first."""
        there, where = self._poses[rows], self._expedition
        views = np.empty((len(there), *self.shape[1:]), np.uint8)
        rng = np.random.default_rng(where.chance(*self._key, rows.start or 0))
        see(where.camera, parsed(where.room), where.body, there, out=views, rng=rng)
        return views


@lru_cache(maxsize=4)
def parsed(room: str) -> Arena:
    """Work out a room once for all that is painted of it."""
    return Arena.parse(room)
