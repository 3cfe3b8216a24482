"""Motors: what becomes of commands on their way to the wheels, which may be swapped, late, weak or slip."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

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
