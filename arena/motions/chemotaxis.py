"""Chemotaxis: back to the source of an odour, again and again."""

import math
from collections.abc import Generator, Iterator
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from arena.angles import signed_turn
from arena.bodies.disc import Disc, Drive, Pose
from arena.errors import ArenaError
from arena.motions.base import Walk, join
from arena.motions.locomotion import STEP, StepLength, random_start, sample_views, turn_by
from arena.rooms.arena import Arena
from arena.settings import Positive, Settings
from arena.smell.odour import OdourField

ENOUGH = 0.5
"""Where it smells less than this share of the strongest stay was no stay at the maximum."""

Leg = tuple[float | None, Iterator[StepLength]]
"""How strong it smells where this is a stay at a maximum, and the steps."""


class Chemotaxis(Settings):
    """Climbs one odour to its maximum, spins there, is pushed away in a random direction, and climbs again.

    A climb goes by strides along the gradient, quartered whenever one no longer smells stronger, and sliding
    along walls. Pushed against a wall the body bounces off. Where the source is out of reach, or is smelt
    through a gap that is too narrow for the body, a climb ends at the nearest place that smells strongest.

    The views at the maximum form a ring. Which they are stands in the notes of the walk: `at_maximum` holds
    the first view of each stay and the one after its last, without the stays where it smells less than half
    as strong as at the strongest.

    Parameters
    ----------
    odorant
        Which odour.
    push
        Mean distance by which the body is pushed away, m; it varies by half to either side.
    stride
        First stride of a climb, m.
    precision
        A climb ends when the strides are shorter, m.
    speed
        m/s.
    turn_rate
        Turn rate, rad/s.
    view_every_m, view_every_rad
        A view is taken when the body has moved this far (m) or turned this much (rad) since the last.
    start
        First pose; drawn from free space when None.

    Raises
    ------
    ArenaError
        For parameters out of range.
    """

    default_views: ClassVar[int] = 5_000

    odorant: Annotated[int, Field(ge=0)] = 0
    push: Positive = 1.0
    stride: Positive = 0.2
    precision: Annotated[float, Field(ge=1e-4, le=1)] = 0.01
    speed: Positive = 0.4
    turn_rate: Positive = 1.75
    view_every_m: Positive = 0.12
    view_every_rad: Positive = 0.35
    start: Pose | None = None

    def walk(self, arena: Arena, body: Disc, views: int | None, rng: np.random.Generator) -> Walk:
        """Go and come back until this many views are taken, the first at the start.

        Raises
        ------
        ArenaError
            When the body does not fit, the start is not free, or there is no such odour.
        """
        if self.odorant >= len(arena.sources):
            raise ArenaError(
                f"arena {arena.name!r} has {len(arena.sources)} odour sources, so no odour {self.odorant}; "
                "count them from 0"
            )
        drive = body.place(arena, self.start or random_start(arena, body, rng), rng)
        stays: list[tuple[float, int, int]] = []
        steps = _counted(self._legs(drive, arena.odours, rng), stays)
        walk = join(sample_views(self, drive, steps, views or self.default_views))
        strength, first, last = np.reshape(stays, (-1, 3)).T
        counts = np.rint(walk.times / STEP)
        spans = np.stack([np.searchsorted(counts, first), np.searchsorted(counts, last, "right")], axis=1)
        strong = strength > ENOUGH * strength.max(initial=0)
        return walk._replace(notes={"at_maximum": spans[strong].tolist()})

    def _legs(self, drive: Drive, odours: OdourField, rng: np.random.Generator) -> Iterator[Leg]:
        """Give the legs of the way, one by one."""
        while True:
            yield None, self._climb(drive, odours)
            strength, _ = self._smell(drive, odours)
            angle = rng.choice([-1, 1]) * (2 * math.pi + self.view_every_rad)
            yield strength, turn_by(drive, angle, self.turn_rate)
            yield None, self._go_away(drive, rng)

    def _climb(self, drive: Drive, odours: OdourField) -> Iterator[StepLength]:
        stride = self.stride
        strength, gradient = self._smell(drive, odours)
        while stride > self.precision:
            x, y, heading = drive.pose
            yield from turn_by(drive, signed_turn(heading, gradient), self.turn_rate)
            yield from _run(drive, stride, self.speed, slide=True)
            before, (strength, gradient) = strength, self._smell(drive, odours)
            if strength <= before or math.dist((x, y), drive.pose[:2]) < 0.02 * stride:
                stride *= 0.25

    def _go_away(self, drive: Drive, rng: np.random.Generator) -> Iterator[StepLength]:
        left, angle = self.push * rng.uniform(0.5, 1.5), rng.uniform(-math.pi, math.pi)
        while left > 1e-9:
            yield from turn_by(drive, angle, self.turn_rate)
            left = yield from _run(drive, left, self.speed, slide=False)
            away = drive.pose[2] if drive.contact is None else drive.contact
            angle = signed_turn(drive.pose[2], away + rng.uniform(-0.5, 0.5) * math.pi)

    def _smell(self, drive: Drive, odours: OdourField) -> tuple[float, float]:
        """Give the concentration at the nose, and the direction (rad) in which it rises."""
        xy = np.array([drive.pose[:2]])
        rise, climb = odours.gradient(xy)[0, self.odorant].tolist()
        return odours.concentration(xy)[0, self.odorant].item(), math.atan2(climb, rise)


def _run(drive: Drive, length: float, speed: float, *, slide: bool) -> Generator[StepLength, None, float]:
    """Go straight ahead for a length (m), sliding along walls or stopping there; give what is left of it."""
    while length > 1e-9 and (slide or drive.contact is None):
        drive.step(min(speed, length / STEP), 0.0, STEP)
        yield drive.speed * STEP, abs(drive.turn) * STEP
        length -= drive.speed * STEP
    return length


def _counted(legs: Iterator[Leg], stays: list[tuple[float, int, int]]) -> Iterator[StepLength]:
    """Join legs; note of every stay how strong it smells and the steps between which it lasts."""
    step = 0
    for strength, leg in legs:
        first = step
        for way in leg:
            step += 1
            yield way
        if strength is not None:
            stays.append((strength, first, step))
