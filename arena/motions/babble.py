"""Motor babbling: smooth random commands, whatever comes of them, from which a motor model is learnt."""

import math
from typing import Annotated, ClassVar

import numpy as np
from jaxtyping import Float
from pydantic import Field

from arena.bodies.disc import Disc, Pose
from arena.motions.base import Walk
from arena.motions.locomotion import random_start
from arena.motions.policy import Policy, Sensed
from arena.rooms.arena import Arena
from arena.settings import Positive, Settings


class Babble(Settings):
    r"""Speeds and turns at random, forwards and backwards, heedless of what is sensed and of walls.

    .. math:: u_k = \mathrm{clip}(\sigma x_k, -1, 1), \qquad
        x_{k + 1} = e^{-\Delta / \tau} x_k + \sqrt{1 - e^{-2 \Delta / \tau}} \, \xi_k

    with independent standard normal ξ for speed and turn, so that a recording of 400 views shows what every
    command does. The recording has the `commands`.

    Parameters
    ----------
    speed, turn
        σ of either command, as shares of what the body can do.
    correlation_time
        τ, s.
    dt
        Δ, the time from a view and its command to the next, s.
    start
        First pose; drawn from free space when None.

    Raises
    ------
    ArenaError
        For parameters out of range.

    References
    ----------
    Y. Demiris, A. Dearden (2005), From motor babbling to hierarchical learning by imitation, EPIROB.
    """

    default_views: ClassVar[int] = 400

    speed: Annotated[float, Field(gt=0, le=1)] = 0.6
    turn: Annotated[float, Field(gt=0, le=1)] = 0.5
    correlation_time: Positive = 0.6
    dt: Positive = 0.2
    start: Pose | None = None

    def policy(self, rng: np.random.Generator, explorers: int) -> Policy:
        """Make a policy for this many explorers, each with commands of its own; it never stops."""
        memory = math.exp(-self.dt / self.correlation_time)
        kick = math.sqrt(1 - memory**2)
        wish = rng.standard_normal((explorers, 2))

        def babble(sensed: Sensed) -> Float[np.ndarray, "explorers 2"]:  # noqa: ARG001
            command: np.ndarray = np.clip(wish * [self.speed, self.turn], -1, 1)
            wish[:] = memory * wish + kick * rng.standard_normal(wish.shape)
            return command

        return babble

    def walk(self, arena: Arena, body: Disc, views: int | None, rng: np.random.Generator) -> Walk:
        """Babble until this many views are taken, the first at the start.

        Raises
        ------
        ArenaError
            When the body does not fit, or the start is not free.
        """
        drive = body.place(arena, self.start or random_start(arena, body, rng), rng)
        policy, count = self.policy(rng, 1), views or self.default_views
        poses, commands = np.empty((count, 3)), np.empty((count, 2))
        for view in range(count):
            poses[view], commands[view] = drive.pose, policy({})
            speed, turn = body.velocities(commands[view]).tolist()
            drive.step(speed, turn, self.dt)
        return Walk(self.dt * np.arange(count), poses, commands=commands)
