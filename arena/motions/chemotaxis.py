"""Back to the source of an odour, again and again."""

import math
from collections.abc import Iterator
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from arena.arena import Arena
from arena.body import Body, Drive, Pose
from arena.errors import ArenaError
from arena.motions import Walk
from arena.motions.stepping import STEP, Positive, Way, look, random_start, turn_by
from arena.odour import OdourField
from arena.settings import Settings

ENOUGH = 0.5
"""Less than this share of the strongest smell met is no maximum."""


class Chemotaxis(Settings):
    """Climbs one odour to its maximum, spins there, is pushed away in a random direction, and climbs again.

    A climb goes by strides along the gradient, quartered whenever one no longer smells stronger, and sliding
    along walls. Where it gets stuck at less than the strongest smell met so far, the body is pushed at once.

    The views at the maximum form a ring. Which they are stands in the notes of the walk: `at_maximum` holds
    the first view of each stay and the one after its last.

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
    pace
        Turn rate, rad/s.
    spacing, angle
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
    pace: Positive = 1.75
    spacing: Positive = 0.12
    angle: Positive = 0.35
    start: Pose | None = None

    def walk(self, arena: Arena, body: Body, views: int | None, rng: np.random.Generator) -> Walk:
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
        drive = body.place(arena, self.start or random_start(arena, body, rng))
        stays: list[tuple[int, int]] = []
        ways = _counted(self._legs(drive, body, arena.odours, rng), stays)
        walk = look(drive, ways, views or self.default_views, spacing=self.spacing, angle=self.angle)
        steps = np.rint(walk.times / STEP)
        begin = np.searchsorted(steps, [first for first, _ in stays])
        end = np.searchsorted(steps, [last for _, last in stays], side="right")
        return walk._replace(notes={"at_maximum": np.stack([begin, end], axis=1).tolist()})

    def _legs(
        self, drive: Drive, body: Body, odours: OdourField, rng: np.random.Generator
    ) -> Iterator[tuple[bool, Iterator[Way]]]:
        """Give one leg of the way after the other, and whether it is a stay at the maximum."""
        pace, speed = min(self.pace, body.max_turn), min(self.speed, body.max_speed)
        strongest = 0.0
        while True:
            yield False, self._climb(drive, odours, pace, speed)
            strength, _ = self._smell(drive, odours)
            if strength > ENOUGH * strongest:
                strongest = max(strength, strongest)
                yield True, turn_by(drive, rng.choice([-1, 1]) * 2 * math.pi, pace)
            yield False, turn_by(drive, rng.uniform(-math.pi, math.pi), pace)
            yield False, _run(drive, self.push * rng.uniform(0.5, 1.5), speed, slide=False)

    def _climb(self, drive: Drive, odours: OdourField, pace: float, speed: float) -> Iterator[Way]:
        stride = self.stride
        strength, gradient = self._smell(drive, odours)
        while stride > self.precision:
            x, y, heading = drive.pose
            yield from turn_by(drive, math.remainder(gradient - heading, 2 * math.pi), pace)
            yield from _run(drive, stride, speed, slide=True)
            before, (strength, gradient) = strength, self._smell(drive, odours)
            if strength <= before or math.dist((x, y), drive.pose[:2]) < 0.02 * stride:
                stride *= 0.25

    def _smell(self, drive: Drive, odours: OdourField) -> tuple[float, float]:
        """Give the concentration at the nose, and the direction (rad) in which it rises."""
        xy = np.array([drive.pose[:2]])
        rise, climb = odours.gradient(xy)[0, self.odorant].tolist()
        return odours.concentration(xy)[0, self.odorant].item(), math.atan2(climb, rise)


def _run(drive: Drive, length: float, speed: float, *, slide: bool) -> Iterator[Way]:
    while length > 1e-9 and (slide or drive.contact is None):
        drive.step(min(speed, length / STEP), 0.0, STEP)
        yield drive.speed * STEP, abs(drive.turn) * STEP
        length -= drive.speed * STEP


def _counted(legs: Iterator[tuple[bool, Iterator[Way]]], stays: list[tuple[int, int]]) -> Iterator[Way]:
    """Join legs, noting the steps between which the stays last."""
    step = 0
    for stays_there, leg in legs:
        first = step
        for way in leg:
            step += 1
            yield way
        if stays_there:
            stays.append((first, step))
