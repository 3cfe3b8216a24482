"""Linear track: to and fro along a corridor."""

import math
from collections.abc import Iterator
from typing import ClassVar

import numpy as np

from arena.bodies.disc import Disc, Drive
from arena.motions.base import Striding, Walk
from arena.motions.corridor import corridor
from arena.motions.locomotion import Point, StepLength, bearing, go_to, sample_views, turn_by
from arena.rooms.arena import Arena
from arena.settings import Positive, Settings, Spread

ROOM = 0.02
"""Kept from walls along the way, where there is as much, m."""


class Track(Striding, Settings):
    """Runs straight from one end to the other and back, with a turn to either side at random at each end.

    The speed varies from run to run, and where it ends by `view_every_m`, so that no two runs see the same.

    Parameters
    ----------
    ends
        Two points, m; those of the longest straight way in the room when None.
    speed, speed_spread
        Mean and standard deviation over runs, m/s.
    turn_rate
        Turn rate at the ends, rad/s.
    view_every_m, view_every_rad
        A view is taken when the body has moved this far (m) or turned this much (rad) since the last.

    Raises
    ------
    ArenaError
        For parameters out of range.
    """

    default_views: ClassVar[int] = 2_000

    ends: tuple[Point, Point] | None = None
    speed: Positive = 0.4
    speed_spread: Spread = 0.1
    turn_rate: Positive = 1.75
    view_every_m: Positive = 0.12
    view_every_rad: Positive = 0.35

    def strides(
        self, arena: Arena, body: Disc, views: int | None, rng: np.random.Generator
    ) -> Iterator[Walk]:
        """Go to and fro until this many views are taken, the first at the first end.

        Raises
        ------
        ArenaError
            When the body does not fit, or something is in the way.
        """
        here, there, _ = corridor(arena, body, ROOM, self.ends)
        drive = body.place(arena, (*here, math.atan2(there[1] - here[1], there[0] - here[0])), rng)
        return sample_views(self, drive, self._runs(drive, here, there, rng), views or self.default_views)

    def _runs(
        self, drive: Drive, here: Point, there: Point, rng: np.random.Generator
    ) -> Iterator[StepLength]:
        while True:
            speed = max(0.2 * self.speed, rng.normal(self.speed, self.speed_spread))
            short = rng.random() * min(0.5, self.view_every_m / math.dist(here, there))
            x, y = (b + short * (a - b) for a, b in zip(here, there, strict=True))
            yield from go_to(drive, (x, y), speed)
            here, there = there, here
            back, side = bearing(drive.pose, there), rng.choice([-1, 1])
            yield from turn_by(drive, side * (side * back % (2 * math.pi)), self.turn_rate)
