"""Slow turning: a walk on which the head turns slowly, whichever way the body goes."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from arena.angles import wrap_angle
from arena.bodies.disc import Disc
from arena.motions.base import Walk
from arena.motions.brownian import Brownian
from arena.rooms.arena import Arena
from arena.settings import Positive, Settings, Spread


class SlowTurning(Settings):
    """The way of `Brownian`, while the head wanders by itself from view to view.

    The steps of its heading are normal and independent, so that it is forgotten after 2 / `turn`² views, 800
    by default, while the body runs a metre from view to view and has crossed the room after five.

    Parameters
    ----------
    turn
        Standard deviation of the change of heading from view to view, rad.
    view_every_m
        Way from view to view, m.

    Raises
    ------
    ArenaError
        For parameters out of range.
    """

    default_views: ClassVar[int] = 17_000

    turn: Spread = 0.05
    view_every_m: Positive = 1.0

    def walk(self, arena: Arena, body: Disc, views: int | None, rng: np.random.Generator) -> Walk:
        """Wander until this many views are taken.

        Raises
        ------
        ArenaError
            When the body does not fit.
        """
        # Looking around takes no views of its own.
        way = Brownian(view_every_m=self.view_every_m, view_every_rad=100.0).walk(arena, body, views, rng)
        gaze = way.poses[0, 2] + np.cumsum(self.turn * rng.standard_normal(len(way.poses)))
        return way._replace(poses=np.column_stack([way.poses[:, :2], wrap_angle(gaze)]))
