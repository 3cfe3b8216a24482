"""Locomotion that motions share: the length of a step, turning, going, and taking views on the way."""

import math
from collections.abc import Iterator
from typing import Protocol, runtime_checkable

import numpy as np
from shapely.geometry.base import BaseGeometry

from arena.angles import signed_turn
from arena.bodies.disc import Disc, Drive, Pose
from arena.errors import ArenaError
from arena.motions.base import Walk
from arena.rooms.arena import Arena

STEP = 0.05
"""Length of a physics step, s."""
STEER = 2.0
"""Turn rate per error of heading, 1/s: so slow that a body that misses its goal passes it, not orbits it."""

STRIDE = 256
"""Views that are given at a time."""

Point = tuple[float, float]
"""x and y in m."""

StepLength = tuple[float, float]
"""How far a step went (m) and turned (rad), neither negative."""


@runtime_checkable
class LooksOften(Protocol):
    """A motion that looks when it has moved this far (m) or turned this much (rad) since the last view."""

    view_every_m: float
    view_every_rad: float


def sample_views(motion: LooksOften, drive: Drive, steps: Iterator[StepLength], views: int) -> Iterator[Walk]:
    """Take a view at the start and after every `view_every_m` or `view_every_rad`, whichever comes first.

    Parameters
    ----------
    motion
        How often it looks.
    drive
        The body.
    steps
        Makes the drive step by `STEP`, for ever, and tells how far.
    views
        How many to take; they are given `STRIDE` at a time.
    """
    times, poses, left = [0.0], [drive.pose], views
    gone = turned = 0.0
    for now, (way, turn) in enumerate(steps, start=1):
        if len(times) == min(STRIDE, left):
            yield Walk(np.array(times), np.array(poses))
            left -= len(times)
            times, poses = [], []
        if not left:
            break
        gone += way
        turned += turn
        if gone >= motion.view_every_m or turned >= motion.view_every_rad:
            times.append(now * STEP)
            poses.append(drive.pose)
            gone = turned = 0.0


def turn_by(drive: Drive, angle: float, turn_rate: float) -> Iterator[StepLength]:
    """Turn on the spot by an angle (rad) at a turn rate (rad/s), or as fast as the body can."""
    most = min(turn_rate, drive.body.max_turn) * STEP
    while angle:
        turn = math.copysign(min(abs(angle), most), angle)
        drive.step(0.0, turn / STEP, STEP)
        yield 0.0, abs(turn)
        angle -= turn
    # What a slow body turned too little while it sped up it turns while it stops.
    yield from _rest(drive)


def bearing(pose: Pose, goal: Point) -> float:
    """By how much to turn (rad, the short way) to face a goal (m)."""
    x, y, heading = pose
    return signed_turn(heading, math.atan2(goal[1] - y, goal[0] - x))


def go_to(drive: Drive, goal: Point, speed: float) -> Iterator[StepLength]:
    """Go to a goal (m) straight ahead at a speed (m/s) or the body's, until there, past it, or a hit."""
    braking = 2 * (drive.body.max_acceleration or math.inf)
    while True:
        pose = drive.pose
        left, error = math.dist(pose[:2], goal), bearing(pose, goal)
        if left < 1e-6 or abs(error) > 0.5 * math.pi or drive.contact is not None:
            break
        drive.step(min(speed, left / STEP, math.sqrt(braking * left)), STEER * error, STEP)
        yield drive.speed * STEP, abs(drive.turn) * STEP
    yield from _rest(drive)


def _rest(drive: Drive) -> Iterator[StepLength]:
    """Let a body that cannot stop at once come to rest."""
    body = drive.body
    while (body.max_acceleration and drive.speed) or (body.max_turn_acceleration and drive.turn):
        drive.step(0.0, 0.0, STEP)
        yield drive.speed * STEP, abs(drive.turn) * STEP


def free_space(arena: Arena, body: Disc) -> BaseGeometry:
    """Give the places of the body's centre.

    Raises
    ------
    ArenaError
        When the body fits nowhere.
    """
    region = arena.free_space(body.radius)
    if region.area < 1e-6:
        raise ArenaError(
            f"a body of radius {body.radius:g} m has no free space in arena {arena.name!r}; "
            "take a smaller one"
        )
    return region


def random_start(arena: Arena, body: Disc, rng: np.random.Generator) -> Pose:
    """Draw a pose from free space.

    Raises
    ------
    ArenaError
        When the body fits nowhere.
    """
    x, y = arena.sample_free(1, body.radius, rng)[0].tolist()
    return x, y, rng.uniform(-np.pi, np.pi)
