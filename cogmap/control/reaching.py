"""The policy that reaches: one decision after the other, for one explorer or a batch."""

from __future__ import annotations

from enum import IntEnum
from itertools import pairwise

import numpy as np
from jaxtyping import Float, Int

from arena.angles import wrap_angle
from arena.motions.policy import Sensed
from cogmap.control.motor_model import body_motion, carried
from cogmap.control.percept import Percept, Views
from cogmap.control.steering import Steering
from cogmap.errors import CogmapError
from cogmap.map.novelty import KNOWN, check_known
from cogmap.navigation.place_graph import PlaceGraph

NEAR = 2.0
"""Decisions' ways from the goal within which the body may go backwards."""
ALIGNED = 0.6
"""Error of direction (rad) from which on the body only turns."""
EASE = 8
"""Decisions near the goal in which what counts as reached doubles: as exact as slips and noise allow."""
SETTLED = 2
"""Decisions at the goal after which it stops."""
PATIENCE = 10
"""Decisions in unknown places after which it gives up."""
TRUSTED = 0.5
"""How much of what was foretold of its motion what is seen of it corrects."""
STALLED = 50
"""Decisions without getting nearer along the way after which it gives up: backing off, too, is motion."""
HELD = 3
"""Decisions without the motion that was commanded after each of which it backs off."""


class Outcome(IntEnum):
    """What became of a journey."""

    ON_THE_WAY = 0
    ARRIVED = 1
    UNREACHABLE = 2
    """No way of remembered places leads there."""
    STUCK = 3
    """Commands no longer move it."""
    LOST = 4
    """What it sees is nothing that it remembers."""


REASONS = {
    Outcome.ON_THE_WAY: "it is on its way",
    Outcome.ARRIVED: "",
    Outcome.UNREACHABLE: "no way through remembered places leads from the start to the goal; explore between",
    Outcome.STUCK: "it no longer moves as commanded: something holds it; free it and start again",
    Outcome.LOST: "what it sees is nothing that it remembers; refine the map with views from here",
}


class Reaching:
    """A policy (`arena.Policy`) that goes where images were taken; `Reacher.towards` makes it.

    At each decision the map perceives where the body is. What is still to come of the last command is
    foretold, and how far a body with mass coasts, and from there the body turns to the next corner of its
    way, goes there, and at the last looks as the goal does. So it brakes in time without a plan for it.
    Where it does not move as commanded it backs off; what is seen in unknown places is bridged by what the
    motor model foretells.

    Attributes
    ----------
    outcomes_ : (explorers,)
        What became of each (`Outcome`).
    """

    def __init__(
        self, percept: Percept, ways: PlaceGraph, steering: Steering, goals: Views, *, single: bool = False
    ) -> None:
        count, there = len(goals), percept.perceive(goals)
        check_known(there, "goal")
        self._percept, self._ways, self._steering, self._single = percept, ways, steering, single
        self._goals, self._goal = goals, there.position.astype(np.float64)
        self._last, self._before = np.zeros((count, 2)), np.zeros((count, 2))
        self._position, self._phase = np.full((count, 2), np.nan), np.full(count, np.nan)
        self._motion = np.full((count, 3), np.nan)
        self._ahead: list[list[Float[np.ndarray, "2"]]] = [[] for _ in range(count)]
        self._tries, self._at_goal, self._held, self._unknown = (np.zeros(count, int) for _ in range(4))
        self._backing, self._stale, self._left = (
            np.zeros(count, int),
            np.zeros(count, int),
            np.full(count, np.inf),
        )
        self._docked, self._backwards = np.zeros(count, bool), np.zeros(count, bool)
        self.outcomes_ = np.full(count, Outcome.ON_THE_WAY, int)

    @property
    def reasons_(self) -> list[str]:
        """Why each has not arrived, in words; empty for those that have."""
        return [REASONS[Outcome(outcome)] for outcome in self.outcomes_]

    def __call__(self, sensed: Sensed) -> Float[np.ndarray, "2"] | Float[np.ndarray, "explorers 2"] | None:
        """Decide."""
        views = sensed["view"][None] if self._single else sensed["view"]
        if len(views) != len(self._goal):
            raise CogmapError(f"there are {len(views)} explorers but {len(self._goal)} goals; give one each")
        live = np.flatnonzero(self.outcomes_ == Outcome.ON_THE_WAY)
        commands = np.full((len(views), 2), np.nan)
        if len(live):
            self._look(live, views[live])
            live = live[self.outcomes_[live] == Outcome.ON_THE_WAY]
        if len(live):  # not all of them got lost or stuck
            commands[live] = self._decide(live, views[live])
            self._before[live], self._last[live] = self._last[live], commands[live]
            stopped = self.outcomes_[live] != Outcome.ON_THE_WAY
            commands[live[stopped]] = np.nan
        if not self._single:
            return commands
        return None if np.isnan(commands).all() else commands[0]

    def _look(self, live: Int[np.ndarray, "live"], views: Views) -> None:
        """Tell where these are, and whether they moved as commanded."""
        seen = self._percept.perceive(views)
        position, phase = seen.position.astype(np.float64), seen.phase.astype(np.float64)
        unmoved = np.isnan(self._motion[live])
        expected = self._steering.moves(
            self._last[live], self._before[live], np.where(unmoved, 0, self._motion[live])
        )
        foretold, facing = carried(self._position[live], self._phase[live], expected)
        began = np.isfinite(self._phase[live])
        unknown = np.asarray(seen.novelty) > KNOWN
        self._unknown[live] = np.where(unknown, self._unknown[live] + 1, 0)
        bridged = unknown & began
        position[bridged], phase[bridged] = foretold[bridged], facing[bridged]
        wanted = np.linalg.norm(foretold - self._position[live], axis=1)
        gone = np.linalg.norm(position - self._position[live], axis=1)
        held = began & (wanted > 0.3 * self._steering.pace) & (gone < 0.3 * wanted)
        self._held[live] = np.where(
            held, self._held[live] + 1, np.where(gone > 0.3 * wanted, 0, self._held[live])
        )
        self._backing[live[held & (self._held[live] % HELD == 0)]] = 2
        moved = body_motion(self._position[live], self._phase[live], position, phase)
        self._motion[live] = np.where(unmoved, moved, expected + TRUSTED * (moved - expected))
        self._position[live], self._phase[live] = position, phase
        self.outcomes_[live[self._unknown[live] >= PATIENCE]] = Outcome.LOST
        for explorer in live[~began].tolist():
            self._plan(explorer)

    def _plan(self, explorer: int) -> None:
        try:
            way = self._ways.plan(self._position[explorer], self._goal[explorer])
        except CogmapError:
            self.outcomes_[explorer] = Outcome.UNREACHABLE
        else:
            self._ahead[explorer] = list(way[1:])

    def _decide(self, live: Int[np.ndarray, "live"], views: Views) -> Float[np.ndarray, "live 2"]:
        steering = self._steering
        position, phase = steering.coming(
            self._position[live], self._phase[live], self._last[live], np.nan_to_num(self._motion[live])
        )
        coasting = np.linalg.norm(position - self._position[live], axis=1)
        rests = (coasting < steering.close) & (
            np.abs(wrap_angle(phase - self._phase[live])) < steering.facing
        )
        target = np.array(
            [self._corner(explorer, here) for explorer, here in zip(live.tolist(), position, strict=True)]
        )
        last = np.array([len(self._ahead[explorer]) == 1 for explorer in live])
        step = target - position
        far = np.linalg.norm(step, axis=1)
        bearing = wrap_angle(np.arctan2(step[:, 1], step[:, 0]) - phase - steering.course)
        # whoever goes backwards keeps to it for a while, lest a body that coasts changes its mind for ever
        reach = np.where(self._backwards[live], 2, 1) * NEAR * steering.pace
        backwards = last & (far < reach) & (np.abs(bearing) > np.pi / 2)
        self._backwards[live] = backwards
        bearing = np.where(backwards, wrap_angle(bearing + np.pi), bearing)
        forward = np.where(backwards, -far, far) * np.clip(1 - np.abs(bearing) / ALIGNED, 0, 1)
        self._tries[live] += last & (far < steering.pace) & (coasting < steering.pace)
        ease = 2.0 ** (self._tries[live] / max(EASE, steering.coasting))
        docked = last & (far < steering.close * ease * np.where(self._docked[live], 2, 1))
        self._docked[live] = docked
        left = far + [_length(self._ahead[explorer]) for explorer in live.tolist()]
        nearer = docked | (left < self._left[live] - steering.close)
        self._left[live] = np.where(nearer, left, self._left[live])
        self._stale[live] = np.where(nearer, 0, self._stale[live] + 1)
        stalled = self._stale[live] >= STALLED + 4 * steering.coasting
        self.outcomes_[live[stalled]] = Outcome.STUCK
        turn = bearing
        if docked.any():
            here = self._percept.turns(views[docked], self._goals[live[docked]])
            # what is still to come of the last command is not seen yet
            turn[docked] = wrap_angle(here - wrap_angle(phase - self._phase[live])[docked])
        forward[docked] = 0
        backing = self._backing[live] > 0
        forward[backing], turn[backing] = -0.5 * steering.pace, 0
        self._backing[live] = np.maximum(self._backing[live] - 1, 0)
        there = docked & (np.abs(turn) < steering.facing * ease)
        forward[there] = turn[there] = 0
        self._at_goal[live] = np.where(there, self._at_goal[live] + 1, 0)
        self.outcomes_[live[rests & (self._at_goal[live] >= SETTLED)]] = Outcome.ARRIVED
        return steering.command(forward, turn)

    def _corner(self, explorer: int, here: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
        """Give the next corner of a way, those left out that were reached or can be cut."""
        ahead = self._ahead[explorer]
        while len(ahead) > 1 and (
            np.linalg.norm(ahead[0] - here) < 0.1 * self._steering.pace or self._ways.sees(here, ahead[1])
        ):
            ahead.pop(0)
        if not self._ways.is_free(here, ahead[0]):
            self._plan(explorer)
            ahead = self._ahead[explorer]
        return ahead[0]


def _length(way: list[Float[np.ndarray, "2"]]) -> float:
    """Measure a way along its corners."""
    return float(sum(np.linalg.norm(b - a) for a, b in pairwise(way)))
