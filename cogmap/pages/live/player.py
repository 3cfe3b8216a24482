"""The player of a session: it takes what is done in a browser, lets time pass, and gives what has changed."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cogmap.pages.live.frames import dreamt_frames, frame
from cogmap.pages.live.scenery import Json, room_lines
from cogmap.pages.live.session import Session

Act = Callable[[Session], None]


@dataclass(frozen=True)
class Update:
    """What has changed since the last one."""

    frame: Json
    room: Json | None
    """The room anew, where a box was moved or put back."""
    dreamt: list[str]
    """Views of the way that were dreamt since."""
    first: int
    """Which of them all the first of these is: 0 begins another way."""


class Player:
    """Plays one session. Acts wait until its next turn, so that they may come from another thread.

    Parameters
    ----------
    session
        The explorer.
    """

    def __init__(self, session: Session) -> None:
        self.session = session
        self._acts: deque[Act] = deque()
        self._last, self._sent_dreams, self._room, self._version = 0, 0, session.room, -1

    def do(self, act: Act) -> None:
        """Do something to the session at its next turn."""
        self._acts.append(act)

    def hear(self, said: Any) -> None:
        """Take what a browser says; what is not understood is left."""
        act = understood(said)
        if act is not None:
            self.do(act)
            number = said.get("act")
            self.do(lambda _: self._heard(number))

    def turn(self, seconds: float, *, anew: bool = False) -> Update | None:
        """Do what waits, let time (s) pass, and give what has changed, or all of it when `anew`."""
        session = self.session
        while self._acts:
            self._acts.popleft()(session)
        session.step(seconds)
        if session.version == self._version and not anew:
            return None
        self._version = session.version
        shown = {**frame(session, session.look()), "act": self._last}
        if not session.dreamt or self._sent_dreams > len(session.dreamt):
            self._sent_dreams = 0
        first = self._sent_dreams
        dreamt = dreamt_frames(session, first)
        self._sent_dreams = len(session.dreamt)
        room = None
        if session.room is not self._room or (anew and session.room is not session.world.room):
            room = room_lines(session.room)
        self._room = session.room
        return Update(shown, room, dreamt, first)

    def _heard(self, number: Any) -> None:
        self._last = number if isinstance(number, int) else 0
        self.session.version += 1


def understood(said: Any) -> Act | None:
    """Read what a browser says: stand, turn, drive, set a goal, move a box."""
    if not isinstance(said, Mapping):
        return None
    heading = _numbers([said.get("heading")], 1)
    if (place := _numbers(said.get("stand"), 2)) is not None:
        return lambda session: session.stand(place[0], place[1], None if heading is None else heading[0])
    if (drive := _numbers(said.get("drive"), 2)) is not None:
        return lambda session: session.drive(drive[0], drive[1])
    if (goal := _numbers(said.get("goal"), 2)) is not None:
        return lambda session: session.aim(goal[0], goal[1], 0.0 if heading is None else heading[0])
    box, middle = said.get("box"), _numbers(said.get("place"), 2)
    if isinstance(box, int) and middle is not None:
        return lambda session: session.move_box(box, middle[0], middle[1])
    return None


def _numbers(given: Any, count: int) -> list[float] | None:
    if not isinstance(given, list) or len(given) != count:
        return None
    if not all(isinstance(value, int | float) and np.isfinite(value) for value in given):
        return None
    return [float(value) for value in given]
