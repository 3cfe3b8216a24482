"""Explorers at large: bodies in one room that move, smell and look, all in one call each."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float, Int

from arena.angles import wrap_angle
from arena.bodies.disc import Disc, Pose
from arena.bodies.motors import Motors
from arena.bodies.rolling import CONTACT
from arena.eye.base import Eye
from arena.eye.camera import Camera, Images
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

    def __init__(self, arena: Arena, camera: Eye, *, nose: Nose, body: Disc, count: int) -> None:
        self.arena, self.camera, self.body, self.count = arena, camera, body, count
        self._states = np.full((count, 6), math.nan)
        self._times = np.zeros(count)
        self._rngs: list[np.random.Generator] = [np.random.default_rng(0)] * count
        self._motors = Motors(body, arena, count)
        self._sniffers = Sniffers(nose, count, len(arena.sources))
        self._sensed: Observation = {
            "view": np.zeros((count, camera.height, camera.width, 3), np.uint8),
            "odour": np.zeros((count, len(arena.sources)), np.float32),
        }

    def begin(self, which: Which, starts: Sequence[Pose], rngs: Sequence[np.random.Generator]) -> None:
        """Put these at their starts, at rest.

        Raises
        ------
        ArenaError
            For a start that is not free.
        """
        for k, start, rng in zip(which.tolist(), starts, rngs, strict=True):
            self.body.place(self.arena, start, rng)
            self._states[k], self._rngs[k] = (*start, 0.0, 0.0, math.nan), rng
        self._times[which] = 0.0
        self._motors.begin(which)
        self._sniffers.begin(which)

    def act(self, which: Which, velocities: Float[np.ndarray, "some 2"], dt: float) -> None:
        """Let these obey speeds (m/s) and turn rates (rad/s) for dt (s); the others stay where they are."""
        self._motors.move(self._states, which, velocities, dt, self._generators(which))
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
        """Tell where these are (m, m, rad): the truth."""
        states = self._states[which]
        return np.column_stack([states[:, :2], wrap_angle(states[:, 2])])

    def touched(self, which: Which) -> Bool[np.ndarray, " some"]:
        """Tell whether a wall or the platform's border stopped these in their last step: the truth."""
        stopped: np.ndarray = np.isfinite(self._states[which, CONTACT])
        return stopped

    def _sense(self, which: Which) -> Observation:
        poses, rngs = self.poses(which), self._generators(which)
        concentrations = self.arena.odours.concentration(poses[:, :2])
        view = self._look(poses, rngs)
        return {"view": view, "odour": self._sniffers.smell(which, concentrations, self._times[which], rngs)}

    def _look(self, poses: Float[np.ndarray, "some 3"], rngs: list[np.random.Generator]) -> Images:
        if isinstance(self.camera, Camera):
            return self.camera.render(self.arena, poses, rng=rngs)
        views = np.empty((len(poses), self.camera.height, self.camera.width, 3), np.uint8)
        for view, pose, rng in zip(views, poses[:, None], rngs, strict=True):
            view[:] = self.camera.render(self.arena, pose, rng=rng)[0]
        return views

    def _generators(self, which: Which) -> list[np.random.Generator]:
        return [self._rngs[k] for k in which.tolist()]
