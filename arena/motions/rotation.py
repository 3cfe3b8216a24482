"""Rotation, a spin on the spot: all headings at one place."""

from typing import Annotated, ClassVar

import numpy as np
import shapely
from pydantic import Field

from arena.angles import signed_turn
from arena.bodies.disc import Disc
from arena.motions.base import Walk
from arena.motions.locomotion import STEP, Point, free_space
from arena.rooms.arena import Arena
from arena.settings import Positive, Settings, Share


class Rotation(Settings):
    r"""Some turns to the left at one place, with a view at each of as many headings as there are views.

    .. math:: \theta_k = \theta_0 + 2 \pi T (k + j \xi_k) / n, \qquad \xi_k \text{ uniform in } [0, 1)

    The views lie on a circle, S¹.

    Parameters
    ----------
    position
        Where, m; the free point nearest the middle of the platform when None.
    turns
        T, how many turns.
    jitter
        j. 0 spaces the headings evenly, so that turns repeat them where T and n have a common divisor; 1 puts
        each anywhere in its own n-th of the way.
    turn_rate
        Turn rate, rad/s.

    Raises
    ------
    ArenaError
        For parameters out of range.
    """

    default_views: ClassVar[int] = 5_000

    position: Point | None = None
    turns: Annotated[int, Field(ge=1, le=10_000)] = 10
    jitter: Share = 1.0
    turn_rate: Positive = 1.75

    def walk(self, arena: Arena, body: Disc, views: int | None, rng: np.random.Generator) -> Walk:
        """Turn until this many views are taken.

        Raises
        ------
        ArenaError
            When the body does not fit, or the position is not free.
        """
        views = views or self.default_views
        x, y = self.position or _middle(arena, body)
        drive = body.place(arena, (x, y, rng.uniform(-np.pi, np.pi)), rng)
        goals = 2 * np.pi * self.turns * (np.arange(views) + self.jitter * rng.random(views)) / views
        turn_rate = min(self.turn_rate, body.max_turn)
        times, poses = np.empty(views), np.empty((views, 3))
        now = turned = 0.0
        for view, goal in enumerate(goals.tolist()):
            # More than one step where the body first has to speed up.
            while goal - turned > 1e-9:
                before, dt = drive.pose[2], min(STEP, 1 / turn_rate, (goal - turned) / turn_rate)
                drive.step(0.0, turn_rate, dt)
                # To whichever side: wheels may be swapped.
                turned += abs(signed_turn(before, drive.pose[2]))
                now += dt
            times[view], poses[view] = now, drive.pose
        return Walk(times, poses)


def _middle(arena: Arena, body: Disc) -> Point:
    nearest = shapely.shortest_line(free_space(arena, body), arena.walkable.centroid).coords[0]
    return nearest[0], nearest[1]
