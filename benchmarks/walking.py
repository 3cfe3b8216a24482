"""What a view costs before it is looked at: walk and smell by motion, and the body's step beside pymunk's."""

import time
from collections.abc import Callable

import numpy as np

from arena import Arena, Body, Brownian, Chemotaxis, Cyclic, Motion, Nose, Rotation, Track

MOTIONS: tuple[Motion, ...] = (Rotation(), Cyclic(), Brownian(), Chemotaxis(), Track())
VIEWS = 3000
STEPS = 5000
ROUNDS = 7


def walking() -> dict[str, dict[str, float]]:
    """Measure views per second of every motion with smell and without sight, and microseconds a step."""
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
        walk = motion.walk(room, Body(), VIEWS, rng)
        Nose().smell(room.odours.concentration(walk.poses[:, :2]), walk.times, rng)

    return VIEWS / shortest(work)


def stepped(room: Arena) -> dict[str, float]:
    """Step round a circle in open space, along a wall, and pymunk's own step of the same space, in turn."""
    open_space, wall = Body().place(room, (0.0, 0.0, 0.0)), Body().place(room, (-1.82, -1.32, 0.0))
    space = room.space()

    def circle() -> None:
        for _ in range(STEPS):
            open_space.step(0.2, 1.0, 0.05)

    def slide() -> None:
        for _ in range(STEPS):
            wall.step(0.001, 0.0, 0.05)

    def pymunk() -> None:
        for _ in range(STEPS):
            space.step(0.05)

    wall.step(0.01, -0.5, 0.5)
    return {
        f"{name}_us": 1e6 * shortest(work) / STEPS
        for name, work in (("open_space", circle), ("along_a_wall", slide), ("pymunk", pymunk))
    }


def shortest(work: Callable[[], None]) -> float:
    """Shortest time of a few rounds, s."""
    times = []
    for _ in range(ROUNDS):
        started = time.perf_counter()
        work()
        times.append(time.perf_counter() - started)
    return min(times)
