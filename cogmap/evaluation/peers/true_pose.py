"""The true-pose controller, the peer: an eye that sees the pose itself, and a percept that reads it."""

from __future__ import annotations

from typing import Any

import numpy as np
from jaxtyping import Float, UInt8

from arena import Arena
from arena.angles import wrap_angle
from cogmap.map.activity import Activity

PIXELS = 8
"""Of three bytes each: three double-precision numbers."""


class PoseEye:
    """An eye whose image is the pose, (x, y, heading) in m and rad, byte by byte.

    With it whatever steers by what it sees steers by the truth, and nothing else differs.
    """

    height, width = 1, PIXELS

    def render(
        self, arena: Arena, poses: Float[np.ndarray, "views 3"], *, rng: np.random.Generator
    ) -> UInt8[np.ndarray, "views 1 8 3"]:
        """Write down the poses."""
        del arena, rng
        return np.ascontiguousarray(poses, np.float64).view(np.uint8).reshape(-1, 1, PIXELS, 3)

    def model_dump(self) -> dict[str, Any]:
        """Give its parameters: it has none."""
        return {}


class TruePercept:
    """Perceives poses where a map would perceive views."""

    def perceive(self, views: UInt8[np.ndarray, "views 1 8 3"]) -> Activity:
        """Read position (m) and heading (rad)."""
        poses = np.ascontiguousarray(views).reshape(len(views), -1).view(np.float64)
        nothing = np.empty((len(views), 0))
        return Activity(nothing, nothing, poses[:, 2], nothing, poses[:, :2], novelty=np.zeros(len(views)))

    def turns(
        self, views: UInt8[np.ndarray, "views 1 8 3"], others: UInt8[np.ndarray, "views 1 8 3"]
    ) -> Float[np.ndarray, "views"]:
        """Subtract headings."""
        return wrap_angle(self.perceive(others).phase - self.perceive(views).phase)
