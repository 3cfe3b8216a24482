"""The policy that reaches postures: at each look the next remembered view, and in the end the goal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Bool, Float, Int, UInt8

from arena.motions.policy import Sensed
from cogmap.control.posture_ways import Sight
from cogmap.control.reaching import Outcome
from cogmap.control.visual_jacobian import implied_work
from cogmap.errors import CogmapError
from cogmap.features.image_codes import sharp_codes

if TYPE_CHECKING:
    from cogmap.control.posture_reacher import PostureReacher

STEP = 1.0
"""Babbled steps that the next remembered view is away at least, as nearer ones only turn the course."""
SHARP = 0.2
"""Babbled steps from the goal within which finer codes are compared."""
DAMPED, GAIN = 1.0, 0.5
"""Babbled steps from the goal within which only this share of the work that is left is done at a time."""
CLOSE = 0.026
"""Babbled steps from the goal that count as reached at first,"""
EASE = 16
"""and looks near it in which this doubles: as exact as slips and noise allow."""
SETTLED = 2
"""Looks at the goal after which it stops."""
ALIKE = 3
"""Remembered views, at most, that may look more like what is seen than a goal that is reached."""
NEXT = 15
"""Remembered views, at most, that look more like what is seen than a goal that is the next to go to."""
STALLED, KICKS = 12, 8
"""Looks without coming nearer after which it is kicked, and kicks after which it is stuck."""
KICK = 2.0
"""Size of a kick, babbled steps."""
PATIENCE = 10
"""Looks at what is unlike all that is remembered after which it is lost."""
UNLIKE = 3.0
"""Distance from what is remembered, over the usual one, of what is unlike it."""

REASONS = {
    Outcome.ON_THE_WAY: "it is on its way",
    Outcome.ARRIVED: "",
    Outcome.UNREACHABLE: "no way through remembered views leads to the goal; babble longer",
    Outcome.STUCK: "its motors bring it no nearer: something holds it, or what it sees here misleads it",
    Outcome.LOST: "what it sees is nothing that it remembers; babble here too",
}


class PostureReaching:
    """A policy (`arena.Policy`) that moves joints to where images were taken.

    `PostureReacher.towards` makes it.

    At each look it chooses, among the remembered views that look most like what is seen, the one over which
    the least work leads to the goal, and lets the motors do what the visual Jacobian says leads there. So a
    body that slips, or is held for a while, plans anew. Near the goal it goes by finer codes and by half
    steps, and where it comes no nearer it is kicked at random.

    Attributes
    ----------
    outcomes_ : (explorers,)
        What became of each (`Outcome`).
    """

    def __init__(
        self, reacher: PostureReacher, goals: UInt8[np.ndarray, "_ height width 3"], *, single: bool
    ) -> None:
        count = len(goals)
        self._reacher, self._single = reacher, single
        self._goals, self._sharp = reacher.encode(goals).astype(np.float64), sharp_codes(goals)
        self._jacobians = reacher.jacobian.at(self._goals)
        self._left = reacher.ways.work_left(reacher.ways.look(self._goals))
        seeds = np.random.SeedSequence(reacher.seed).spawn(count)
        self._rngs = [np.random.default_rng(seed) for seed in seeds]
        self._best = np.full(count, np.inf)
        self._looks, self._settled, self._stale, self._kicks, self._unlike = np.zeros((5, count), int)
        self.outcomes_ = np.full(count, Outcome.ON_THE_WAY, int)

    @property
    def reasons_(self) -> list[str]:
        """Why each has not arrived, in words; empty for those that have."""
        return [REASONS[Outcome(outcome)] for outcome in self.outcomes_]

    def __call__(
        self, sensed: Sensed
    ) -> Float[np.ndarray, " motors"] | Float[np.ndarray, "explorers motors"] | None:
        """Decide."""
        views = sensed["view"][None] if self._single else sensed["view"]
        if len(views) != len(self._goals):
            raise CogmapError(f"there are {len(views)} explorers but {len(self._goals)} goals; give one each")
        commands = np.full((len(views), self._jacobians.shape[1]), np.nan)
        live = np.flatnonzero(self.outcomes_ == Outcome.ON_THE_WAY)
        if len(live):
            work = self._decide(live, views[live])
            asked = work / self._reacher.dt
            # what is too much keeps its direction
            asked /= np.maximum(1, np.abs(asked).max(axis=1, keepdims=True))
            going = self.outcomes_[live] == Outcome.ON_THE_WAY
            commands[live[going]] = asked[going]
        if not self._single:
            return commands
        return None if np.isnan(commands).all() else commands[0]

    def _decide(self, live: Int[np.ndarray, " live"], views: Any) -> Float[np.ndarray, "live motors"]:
        """Choose the work of the motors (command · s), and tell of which it is over."""
        ways, pace = self._reacher.ways, self._reacher.jacobian.pace_
        codes = self._reacher.encode(views).astype(np.float64)
        sight = ways.look(codes)
        far = sight.effort
        left = far * ways.costs[sight.indices] + np.take_along_axis(self._left[live], sight.indices, axis=1)
        left[far < STEP * pace] = np.inf
        rows, best = np.arange(len(live)), left.argmin(axis=1)
        work: np.ndarray = sight.work[rows, best]
        left = left[rows, best]
        # Whoever is here and has farther to go than was thought remembers it (learning real-time A*).
        here = (far < STEP * pace) & np.isfinite(left)[:, None]
        toll = np.where(here, far * ways.costs[sight.indices], np.inf)
        known = self._left[live[:, None], sight.indices]
        learnt = np.where(here, left[:, None], 0) - toll
        self._left[live[:, None], sight.indices] = np.maximum(known, learnt)

        straight, unlike = self._straight(live, codes)
        near = np.linalg.norm(straight, axis=1)
        last = (unlike < sight.distances[:, NEXT]) & (near <= left) | (unlike < sight.distances[:, ALIKE])
        sharp = np.flatnonzero(last & (near < SHARP * pace))
        straight[sharp] = self._sharper(live[sharp], codes[sharp], views[sharp])
        near[sharp] = np.linalg.norm(straight[sharp], axis=1)
        straight[near < DAMPED * pace] *= GAIN
        work[last], left[last] = straight[last], near[last]

        self._looks[live] += last & (near < SHARP * pace)
        reached = last & (unlike < sight.distances[:, ALIKE])
        reached &= near < CLOSE * pace * 2.0 ** (self._looks[live] / EASE)
        self._settled[live] = np.where(reached, self._settled[live] + 1, 0)
        kicked = self._stalls(live, left, pace) & ~reached
        for row in np.flatnonzero(kicked):
            way = self._rngs[live[row]].standard_normal(work.shape[1])
            work[row] = KICK * pace * way / np.linalg.norm(way)
        self._judge(live, sight)
        return work

    def _straight(
        self, live: Int[np.ndarray, " live"], codes: Float[np.ndarray, "live features"]
    ) -> tuple[Float[np.ndarray, "live motors"], Float[np.ndarray, " live"]]:
        """Give the work straight to the goals, and how unlike them what is seen is."""
        change = self._goals[live] - codes
        here = implied_work(self._reacher.jacobian.at(codes), change)
        there = implied_work(self._jacobians[live], change)
        return (here + there) / 2, np.linalg.norm(change, axis=1)

    def _sharper(
        self, live: Int[np.ndarray, " live"], codes: Float[np.ndarray, "live features"], views: Any
    ) -> Float[np.ndarray, "live motors"]:
        """Give the work to goals that are near, by finer codes."""
        if not len(live):
            return np.empty((0, self._jacobians.shape[1]))
        jacobians = self._reacher.jacobian.bent(codes, self._reacher.sharp)
        return implied_work(jacobians, self._sharp[live] - sharp_codes(views))

    def _stalls(
        self, live: Int[np.ndarray, " live"], left: Float[np.ndarray, " live"], pace: float
    ) -> Bool[np.ndarray, " live"]:
        """Tell which have come no nearer for long, and count it."""
        nearer = left < self._best[live] - CLOSE * pace
        self._best[live] = np.where(nearer, left, self._best[live])
        self._stale[live] = np.where(nearer, 0, self._stale[live] + 1)
        kicked: np.ndarray = self._stale[live] >= STALLED
        self._kicks[live] += kicked
        self._stale[live[kicked]] = 0
        # from where it is kicked to it comes nearer anew
        self._best[live[kicked]] = np.inf
        return kicked

    def _judge(self, live: Int[np.ndarray, " live"], sight: Sight) -> None:
        """Tell of which it is over."""
        unlike = sight.distances[:, 0] > UNLIKE * self._reacher.ways.spacing
        self._unlike[live] = np.where(unlike, self._unlike[live] + 1, 0)
        self.outcomes_[live[self._kicks[live] > KICKS]] = Outcome.STUCK
        apart = np.isinf(self._left[live[:, None], sight.indices]).all(axis=1)
        self.outcomes_[live[apart]] = Outcome.UNREACHABLE
        self.outcomes_[live[self._unlike[live] >= PATIENCE]] = Outcome.LOST
        self.outcomes_[live[self._settled[live] >= SETTLED]] = Outcome.ARRIVED
