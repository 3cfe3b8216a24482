"""Motors: what becomes of commands on their way to the wheels, which may be swapped, late, weak or slip."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float, Int

from arena.angles import wrap_angle
from arena.bodies.base import Configurations
from arena.bodies.rolling import CONTACT, roll_all

if TYPE_CHECKING:
    from arena.bodies.disc import Disc
    from arena.rooms.arena import Arena

INSTANT = 1e-12
"""Less than this is no time at all, s: sums of steps are rounded."""


class Motors:
    """The motors of bodies of one kind, side by side in a room, each disturbed as alone.

    Parameters
    ----------
    body
        With its disturbances.
    arena
        The room.
    count
        How many bodies.
    """

    def __init__(self, body: Disc, arena: Arena, count: int) -> None:
        self._body, self._edges, self._limits = body, arena.edges, body.limits
        self._obeyed = np.zeros((count, 2))
        self._waiting: deque[tuple[float, np.ndarray]] = deque()

    def begin(self, which: Int[np.ndarray, " some"]) -> None:
        """Let these rest, with no command on its way."""
        for commands in (self._obeyed, *(commands for _, commands in self._waiting)):
            commands[which] = 0.0

    def move(
        self,
        states: Float[np.ndarray, "bodies 6"],
        which: Int[np.ndarray, " some"],
        commands: Float[np.ndarray, "some 2"],
        dt: float,
        rngs: Sequence[np.random.Generator],
    ) -> None:
        """Move these for dt (s) by speed (m/s) and turn rate (rad/s); each slips by its own generator."""
        body = self._body
        gains = np.tile(np.array(body.wheel_gains), (len(which), 1))
        if body.slip:
            gains *= 1 + body.slip * np.array([rng.standard_normal(2) for rng in rngs]).reshape(-1, 2)
        if body.swapped:
            commands = commands * [1.0, -1.0]
        moved, touched = states[which], np.full(len(which), math.nan)
        for part, obeyed in self._parts(which, commands, dt):
            roll_all(moved, self._edges, self._limits, gains, obeyed, part)
            touched = np.where(np.isnan(moved[:, CONTACT]), touched, moved[:, CONTACT])
        moved[:, CONTACT] = touched
        states[which] = moved

    def _parts(self, which: np.ndarray, commands: np.ndarray, dt: float) -> list[tuple[float, np.ndarray]]:
        """Cut a step where commands take effect: how long (s) each part is, and what is obeyed in it."""
        if not self._body.delay:
            return [(dt, commands)]
        late = np.zeros_like(self._obeyed)
        late[which] = commands
        self._waiting.append((self._body.delay, late))
        parts, left = list[tuple[float, np.ndarray]](), dt
        while left > INSTANT:
            due = self._waiting[0][0] if self._waiting else math.inf
            part = left if due > left - INSTANT else due
            parts.append((part, self._obeyed[which]))
            self._waiting = deque((due - part, commands) for due, commands in self._waiting)
            while self._waiting and self._waiting[0][0] < INSTANT:
                self._obeyed = self._waiting.popleft()[1]
            left -= part
        return parts


class Rollers:
    """Discs of one kind at large in a room; see `arena.bodies.base.AtLarge`."""

    def __init__(self, body: Disc, arena: Arena, count: int) -> None:
        self._motors = Motors(body, arena, count)
        self._states = np.full((count, 6), math.nan)

    @property
    def configurations(self) -> Configurations:
        """Where each is: x, y (m) and heading (rad)."""
        return np.column_stack([self._states[:, :2], wrap_angle(self._states[:, 2])])

    @property
    def touched(self) -> Bool[np.ndarray, " bodies"]:
        """Whether a wall or the platform's border stopped it in its last step."""
        stopped: np.ndarray = np.isfinite(self._states[:, CONTACT])
        return stopped

    def begin(self, which: Int[np.ndarray, " some"], configurations: Configurations) -> None:
        """Put these there, at rest."""
        self._states[which] = math.nan
        self._states[which, :3], self._states[which, 3:CONTACT] = configurations, 0.0
        self._motors.begin(which)

    def step(
        self,
        which: Int[np.ndarray, " some"],
        velocities: Float[np.ndarray, "some motors"],
        dt: float,
        rngs: Sequence[np.random.Generator],
    ) -> None:
        """Let these go by m/s and rad/s for dt (s)."""
        self._motors.move(self._states, which, velocities, dt, rngs)
