"""What a view costs before it is looked at: walk and smell by motion, and the body's step beside pymunk's."""

import numpy as np
import pymunk

from arena import Arena, Brownian, Chemotaxis, Cyclic, Disc, Motion, Nose, Rotation, Track
from benchmarks.timing import Figures, seconds, versus

MOTIONS: tuple[Motion, ...] = (Rotation(), Cyclic(), Brownian(), Chemotaxis(), Track())
VIEWS = 3000
STEPS = 5000
ROUNDS = 7


def walking() -> Figures:
    """Walk and smell without sight, views per second of every motion.

    A disc takes steps in open space and along a wall, in turn with pymunk's own step of the same room.
    """
    room = Arena.load("furnished")
    room.odours.concentration(np.zeros((1, 2)))
    return {
        "views_per_s": {type(motion).__name__: walked(room, motion) for motion in MOTIONS},
        "step": stepped(room),
    }


def walked(room: Arena, motion: Motion) -> float:
    """Walk and smell."""

    def work() -> None:
        rng = np.random.default_rng(0)
        walk = motion.walk(room, Disc(), VIEWS, rng)
        Nose().smell(room.odours.concentration(walk.poses[:, :2]), walk.times, rng)

    return VIEWS / seconds(work, ROUNDS)


def stepped(room: Arena) -> Figures:
    """Step round a circle in open space, along a wall, and pymunk's own step of the same space, in turn."""
    open_space, wall = Disc().place(room, (0.0, 0.0, 0.0)), Disc().place(room, (-1.82, -1.32, 0.0))
    space, disc = room.space(), pymunk.Body(mass=1.0, moment=float("inf"))
    space.add(disc, pymunk.Circle(disc, Disc().radius))

    def circle() -> int:
        for _ in range(STEPS):
            open_space.step(0.2, 1.0, 0.05)
        return STEPS

    def slide() -> int:
        for _ in range(STEPS):
            wall.step(0.001, 0.0, 0.05)
        return STEPS

    def alone() -> int:
        for _ in range(STEPS):
            space.step(0.05)
        return STEPS

    wall.step(0.01, -0.5, 0.5)
    return {
        "open_space": versus(circle, alone, beside="pymunk's own step"),
        "along_a_wall": versus(slide, alone, beside="pymunk's own step"),
    }
