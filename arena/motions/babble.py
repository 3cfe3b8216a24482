"""Motor babbling: smooth random commands, whatever comes of them, from which a motor model is learnt."""

import math
from collections.abc import Generator
from typing import Annotated, ClassVar

import numpy as np
from jaxtyping import Float
from pydantic import Field

from arena.bodies.base import Body, Placed, wrapped
from arena.bodies.disc import Disc
from arena.motions.base import Walk
from arena.motions.policy import Policy, Sensed
from arena.rooms.arena import Arena
from arena.settings import Positive, Settings

_Wishes = Generator[tuple[np.ndarray, float], bool, None]
"""Gives commands and how long each holds (s), and is told whether something stopped the body."""


class Babble(Settings):
    r"""Motors driven at random, forwards and backwards, heedless of what is sensed and of walls.

    .. math:: u_k = \mathrm{clip}(\sigma x_k, -1, 1), \qquad
        x_{k + 1} = e^{-\Delta / \tau} x_k + \sqrt{1 - e^{-2 \Delta / \tau}} \, \xi_k

    with independent standard normal ξ for each motor, so that a recording of 400 views shows what every
    command does. The recording has the `commands`, each of which holds from its view to the next.

    A `Disc` is looked through every `dt`. Of any other body a view is taken when its motors have gone as far
    as told; where something stops it x changes its sign; and one whose motors each move an axis of their own
    swings at times at full speed straight to a posture far away, drawn evenly, without which it would stay
    around where it began.

    Parameters
    ----------
    speed, turn
        σ of what goes and of what turns, as shares of what the body can do.
    correlation_time
        τ, s.
    dt
        Δ, the time from a view and its command to the next, s, for a `Disc`.
    view_every_m, view_every_rad
        How far motors go (m) or turn (rad) from a view to the next, together, as the root of the sum of
        squares; no longer than τ.
    swing_every
        Views from the end of a swing to the next.
    start
        Where the body begins on its axes; drawn from what is free when None.

    Raises
    ------
    ArenaError
        For parameters out of range.

    References
    ----------
    Y. Demiris, A. Dearden (2005), From motor babbling to hierarchical learning by imitation, EPIROB.
    """

    default_views: ClassVar[int] = 400
    any_body: ClassVar[bool] = True

    speed: Annotated[float, Field(gt=0, le=1)] = 0.6
    turn: Annotated[float, Field(gt=0, le=1)] = 0.5
    correlation_time: Positive = 0.6
    dt: Positive = 0.2
    view_every_m: Positive = 0.05
    view_every_rad: Positive = 0.1
    swing_every: Annotated[int, Field(ge=1)] = 400
    start: tuple[float, ...] | None = None

    def policy(self, rng: np.random.Generator, explorers: int, body: Body = Disc()) -> Policy:
        """Make a policy for this many explorers, each with commands of its own every dt; it never stops."""
        memory, kick = self._memory(self.dt)
        strength = self._strength(body)
        wish = rng.standard_normal((explorers, len(strength)))

        def babble(sensed: Sensed) -> Float[np.ndarray, "explorers motors"]:  # noqa: ARG001
            command: np.ndarray = np.clip(wish * strength, -1, 1)
            wish[:] = memory * wish + kick * rng.standard_normal(wish.shape)
            return command

        return babble

    def walk(self, arena: Arena, body: Body, views: int | None, rng: np.random.Generator) -> Walk:
        """Babble until this many views are taken, the first at the start.

        Raises
        ------
        ArenaError
            When the body does not fit, or the start is not free.
        """
        start = self.start or tuple(body.sample_free(arena, 1, rng)[0].tolist())
        placed, count = body.place(arena, start, rng), views or self.default_views
        there, commands = np.empty((count, len(body.axes))), np.empty((count, len(body.motors)))
        times = self.dt * np.arange(count + 1)
        wishes = self._every_dt(rng) if isinstance(body, Disc) else self._by_motion(arena, body, placed, rng)
        command, dt = next(wishes)
        for view in range(count):
            there[view], commands[view] = placed.configuration, command
            touched = placed.go(body.velocities(command).tolist(), dt)
            if not isinstance(body, Disc):
                times[view + 1] = times[view] + dt
            command, dt = wishes.send(touched)
        return Walk(times[:-1], there, commands=commands)

    def _every_dt(self, rng: np.random.Generator) -> _Wishes:
        policy = self.policy(rng, 1)
        while True:
            yield np.asarray(policy({}))[0], self.dt

    def _by_motion(self, arena: Arena, body: Body, placed: Placed, rng: np.random.Generator) -> _Wishes:
        every = np.array([self.view_every_m if unit == "m" else self.view_every_rad for unit in body.motors])
        strength, most = self._strength(body), body.velocities(np.ones(len(every)))
        swings = len(body.axes) == len(body.motors)
        wish = rng.standard_normal(len(every))
        while True:
            for _ in range(self.swing_every):
                command = np.clip(strength * wish, -1, 1)
                dt = min(1 / _length(body.velocities(command) / every), self.correlation_time)
                touched = yield command, dt
                memory, kick = self._memory(dt)
                wish *= -memory if touched else memory
                wish += kick * rng.standard_normal(len(wish))
            goal, touched = body.sample_free(arena, 1, rng)[0], not swings
            while not touched:
                way = wrapped(body, goal - placed.configuration)
                left, fastest = _length(way / every), np.abs(way / most).max()
                if left < 1e-9:
                    break
                # a slip may miss the goal: from within a view it is there
                touched = (yield way / most / fastest, fastest / max(left, 1.0)) or left <= 1.0

    def _strength(self, body: Body) -> Float[np.ndarray, " motors"]:
        return np.array([self.speed if unit == "m" else self.turn for unit in body.motors])

    def _memory(self, dt: float) -> tuple[float, float]:
        """Tell what is left of x after dt (s), and how strong ξ is."""
        memory = math.exp(-dt / self.correlation_time)
        return memory, math.sqrt(1 - memory**2)


def _length(way: np.ndarray) -> float:
    # spelt out: a norm is rounded as the processor likes
    return math.sqrt(sum(part * part for part in way.tolist()))
