"""Explorers at large: bodies in one room that move, smell and look, all in one call each."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float, Int

from arena.bodies.base import Body, Configurations, check_starts
from arena.eye.base import AnyEye, see
from arena.rooms.arena import Arena
from arena.smell.nose import Nose, Sniffers

Which = Int[np.ndarray, " some"]
Observation = dict[str, np.ndarray]
"""{"view": (explorers, height, width, 3) uint8, "odour": (explorers, odorants) float32}."""


class Explorers:
    """Explorers of one kind in a room that pass through each other, each the same as alone, bit by bit.

    All bodies move, all noses smell and all eyes are painted in one call each. What is random about one of
    them, its slip, the noise of its eye and of its nose, comes from its own generator, in this order.

    Parameters
    ----------
    arena, camera, nose, body
        The room and the animal.
    count
        How many.
    """

    def __init__(self, arena: Arena, camera: AnyEye, *, nose: Nose, body: Body, count: int) -> None:
        self.arena, self.camera, self.body, self.count = arena, camera, body, count
        self._bodies = body.at_large(arena, count)
        self._times = np.zeros(count)
        self._rngs: list[np.random.Generator] = [np.random.default_rng(0)] * count
        self._sniffers = Sniffers(nose, count, len(arena.sources))
        self._sensed: Observation = {
            "view": np.zeros((count, camera.height, camera.width, 3), np.uint8),
            "odour": np.zeros((count, len(arena.sources)), np.float32),
        }

    def begin(
        self, which: Which, starts: Sequence[tuple[float, ...]], rngs: Sequence[np.random.Generator]
    ) -> None:
        """Put these at their starts on the body's axes, at rest.

        Raises
        ------
        ArenaError
            For a start that is not free.
        """
        if not len(which):
            return
        there = np.array(starts, float)
        check_starts(self.body, self.arena, there)
        for k, rng in zip(which.tolist(), rngs, strict=True):
            self._rngs[k] = rng
        self._times[which] = 0.0
        self._bodies.begin(which, there)
        self._sniffers.begin(which)

    def act(self, which: Which, velocities: Float[np.ndarray, "some motors"], dt: float) -> None:
        """Let the motors of these obey m/s or rad/s for dt (s); the others stay where they are."""
        self._bodies.step(which, velocities, dt, self._generators(which))
        self._times[which] += dt

    def sense(self, which: Which) -> Observation:
        """Let these look and smell: give what all have sensed last. It is never changed later."""
        fresh = self._sense(which)
        if len(which) == self.count:
            self._sensed = fresh
        else:
            self._sensed = {name: last.copy() for name, last in self._sensed.items()}
            for name, values in fresh.items():
                self._sensed[name][which] = values
        return self._sensed

    def poses(self, which: Which) -> Float[np.ndarray, "some 3"]:
        """Tell from where these see and smell (m, m, rad): the truth."""
        return self.body.camera_poses(self.configurations(which))

    def configurations(self, which: Which) -> Configurations:
        """Tell where these are, on the body's axes: the truth."""
        there: Configurations = self._bodies.configurations[which]
        return there

    def touched(self, which: Which) -> Bool[np.ndarray, " some"]:
        """Tell whether something stopped these in their last step: the truth."""
        stopped: np.ndarray = self._bodies.touched[which]
        return stopped

    def _sense(self, which: Which) -> Observation:
        there, rngs = self.configurations(which), self._generators(which)
        concentrations = self.arena.odours.concentration(self.body.camera_poses(there)[:, :2])
        view = np.empty((len(there), self.camera.height, self.camera.width, 3), np.uint8)
        see(self.camera, self.arena, self.body, there, out=view, rng=rngs)
        return {"view": view, "odour": self._sniffers.smell(which, concentrations, self._times[which], rngs)}

    def _generators(self, which: Which) -> list[np.random.Generator]:
        return [self._rngs[k] for k in which.tolist()]
