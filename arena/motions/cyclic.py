"""Cyclic motion: a run along one axis with spins all the way, all headings everywhere on a line."""

import math
from collections.abc import Iterator
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from arena.bodies.disc import Disc, Drive
from arena.motions.base import Striding, Walk
from arena.motions.corridor import corridor
from arena.motions.locomotion import Point, StepLength, bearing, go_to, sample_views, turn_by
from arena.rooms.arena import Arena
from arena.settings import Positive, Settings, Spread

FACING = 0.6
"""How much more than a full spin it takes to face the next corner, on average, rad."""


class Cyclic(Striding, Settings):
    """Zigzags along a straight way with a full spin at every corner, to the end and back.

    The corners are spread so that `passes` of the way take about all views. Each is at random in its own
    part of the way, and across it within ± `width` / 2. As `width` is small beside the length of the way, the
    views lie on a cylinder, R×S¹.

    Parameters
    ----------
    ends
        Of the way, m; those of the longest straight way in the room when None.
    width
        Range across the way, m; less where the room is narrower.
    passes
        How often to go along the way.
    speed
        m/s.
    turn_rate
        Turn rate, rad/s.
    view_every_m, view_every_rad
        A view is taken when the body has moved this far (m) or turned this much (rad) since the last.

    Raises
    ------
    ArenaError
        For parameters out of range.
    """

    default_views: ClassVar[int] = 4_000

    ends: tuple[Point, Point] | None = None
    width: Spread = 0.1
    passes: Annotated[int, Field(ge=1, le=1000)] = 3
    speed: Positive = 0.4
    turn_rate: Positive = 1.75
    view_every_m: Positive = 0.12
    view_every_rad: Positive = 0.175

    def strides(
        self, arena: Arena, body: Disc, views: int | None, rng: np.random.Generator
    ) -> Iterator[Walk]:
        """Go to and fro until this many views are taken, the first at the first end.

        Raises
        ------
        ArenaError
            When the body does not fit, or something is in the way.
        """
        views = views or self.default_views
        start, end, room = corridor(arena, body, self.width / 2, self.ends)
        drive = body.place(arena, (*start, rng.uniform(-np.pi, np.pi)), rng)
        spins = max(1, round(views * self.view_every_rad / (2 * np.pi + FACING) / self.passes))
        steps = self._zigzag(drive, self._corners(start, end, room, spins, rng))
        return sample_views(self, drive, steps, views)

    def _corners(
        self, start: Point, end: Point, room: float, spins: int, rng: np.random.Generator
    ) -> Iterator[Point]:
        along = np.subtract(end, start)
        across = np.array([-along[1], along[0]]) / np.hypot(*along)
        while True:
            for part in (*range(spins), *reversed(range(spins))):
                share, side = (part + rng.random()) / spins, room * rng.uniform(-1, 1)
                x, y = start + share * along + side * across
                yield float(x), float(y)

    def _zigzag(self, drive: Drive, corners: Iterator[Point]) -> Iterator[StepLength]:
        for corner in corners:
            face = bearing(drive.pose, corner)
            yield from turn_by(drive, face + math.copysign(2 * math.pi, face), self.turn_rate)
            yield from go_to(drive, corner, self.speed)
