"""Acting: the loop of looking, deciding and moving, and the journeys of many who are in it at once."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from arena.bodies.base import Body, Configurations, joints_of
from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.explorers import Explorers, Observation
from arena.eye.base import AnyEye
from arena.motions.policy import Policy
from arena.rooms.arena import Arena
from arena.settings import AnyArray, Whole, checked_whole
from arena.smell.nose import Nose

DT = 0.2
"""Time from a decision to the next, s, unless told."""


class Step(NamedTuple):
    """A turn of the loop."""

    poses: Float[np.ndarray, "explorers 3"]
    """From where they looked (m, m, rad): the truth."""
    configurations: Configurations
    """Where they were on the body's axes: the truth."""
    sensed: Observation
    """What they sensed there."""
    commands: Float[np.ndarray, "explorers motors"]
    """What the policy said; NaN for those that have stopped."""
    touched: Bool[np.ndarray, " explorers"]
    """Whether something stopped them while they obeyed: the truth."""


def act_and_look(explorers: Explorers, policy: Policy, dt: float) -> Iterator[Step]:
    """Look, ask a policy about all, and let those obey for dt (s) that go on, until all have stopped.

    The last step, at which the last has stopped, moves nobody.

    Raises
    ------
    ArenaError
        For a dt that is not positive, and commands that are not a number for each motor of each.
    """
    if not 0 < dt < math.inf:
        raise ArenaError(f"dt is {dt} s; give a positive time from a decision to the next")
    everyone = going = np.arange(explorers.count)
    wanted = explorers.count, len(explorers.body.motors)
    while len(going):
        there, poses = explorers.configurations(everyone), explorers.poses(everyone)
        sensed = explorers.sense(going)
        # Whoever is asked may scale what it is handed in place.
        told = np.asarray(policy({name: values.copy() for name, values in sensed.items()}), float)
        if told.shape != wanted:
            raise ArenaError(
                f"a policy gave commands of shape {told.shape}, not of explorers and motors {wanted}"
            )
        going = going[~np.isnan(told[going]).all(axis=1)]
        commands = np.full(wanted, math.nan)
        commands[going] = told[going]
        if not np.isfinite(commands[going]).all():
            raise ArenaError(
                "a policy gave a command that is not finite; give a number for each motor, or all NaN to stop"
            )
        explorers.act(going, explorers.body.velocities(commands[going]), dt)
        touched = np.zeros(explorers.count, bool)
        touched[going] = explorers.touched(going)
        yield Step(poses, there, sensed, commands, touched)


class Journeys(NamedTuple):
    """Ways of many explorers that were steered by a policy. All but the commands is the truth."""

    times: Float[np.ndarray, " looks"]
    """s; one more than steps."""
    poses: Float[np.ndarray, "looks explorers 3"]
    """x, y in m and heading in rad, of the eye; an explorer that has stopped stays."""
    commands: Float[np.ndarray, "steps explorers motors"]
    """As the policy gave them; NaN from where it has stopped."""
    touched: Bool[np.ndarray, "steps explorers"]
    """Whether something stopped the step: a wall, the platform's border, the end of an axis."""
    steps: Int[np.ndarray, " explorers"]
    """How many commands each has obeyed: the row of `poses` from which on it stands still."""
    joints: Float[np.ndarray, "looks explorers axes"] | None = None
    """Where the body was on its axes, row by row as `poses`; None for a disc, of which poses tell all."""


def journeys(
    arena: Arena,
    policy: Policy,
    camera: AnyEye,
    starts: AnyArray,
    *,
    nose: Nose = Nose(),
    body: Body = Disc(),
    dt: float = DT,
    most_steps: Whole,
    seed: Whole = 0,
) -> Journeys:
    """Let many explorers go at once, in one room, steered by one policy, without keeping what they saw.

    An explorer's journey is the same whoever goes beside it, if the policy treats each by itself.

    Parameters
    ----------
    arena, policy, camera, nose, body
        The room, what steers, and the animal. The policy is asked about all explorers at every step.
    starts
        Where each is on the body's axes: x, y (m) and heading (rad) of a disc, the joints of an arm.
    dt
        Time from a decision to the next, s.
    most_steps
        Steps after which those that still go are left.
    seed
        Of slip and of the noise of eye and nose; explorer k has the k-th generator that it spawns.

    Raises
    ------
    ArenaError
        For a start that is not free, a count or seed out of range, and commands that mean nothing.
    """
    starts = np.asarray(starts, np.float64)
    if not len(starts):
        raise ArenaError("there are no starts; give one for each explorer")
    most_steps, seed = checked_whole("most_steps", most_steps, 1), checked_whole("seed", seed)
    everyone = np.arange(len(starts))
    explorers = Explorers(arena, camera, nose=nose, body=body, count=len(starts))
    rngs = [np.random.default_rng(child) for child in np.random.SeedSequence(seed).spawn(len(starts))]
    explorers.begin(everyone, [tuple(start) for start in starts.tolist()], rngs)
    loop = islice(act_and_look(explorers, policy, dt), most_steps)
    gone = [(step.poses, step.configurations, step.commands, step.touched) for step in loop]
    poses, there, commands, touched = (np.array(rows) for rows in zip(*gone, strict=True))
    moving = np.isfinite(commands[:, :, 0])
    steps = int(moving.any(axis=1).sum())
    return Journeys(
        dt * np.arange(steps + 1),
        np.concatenate([poses[:steps], explorers.poses(everyone)[None]]),
        commands[:steps],
        touched[:steps],
        moving.sum(axis=0),
        joints_of(body, np.concatenate([there[:steps], explorers.configurations(everyone)[None]])),
    )
