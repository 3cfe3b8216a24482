"""The turntable: an eye that turns on the spot."""

import numpy as np

from arena.bodies.base import Axis, Configurations
from arena.bodies.jointed import Jointed, Metres, Point, Speed
from arena.bodies.linkage import Chain


class Turntable(Jointed):
    """An eye on a pivot: one circle. From above it is a pointer, turned the way that the eye looks.

    Parameters
    ----------
    base
        Where it turns, m.
    length, width
        Of the pointer, m.
    max_turn
        rad/s.
    height, slip, motor_gains
        See `arena.bodies.jointed.Jointed`.

    Raises
    ------
    ArenaError
        For parameters out of range.
    """

    base: Point = (0.0, 0.0)
    length: Metres = 0.4
    width: Metres = 0.16
    max_turn: Speed = np.pi

    @property
    def axes(self) -> tuple[Axis, ...]:
        """Its one joint."""
        return (Axis("angle", "circle", "rad"),)

    @property
    def radius(self) -> float:
        """Half of how thick the pointer is, m."""
        return self.width / 2

    @property
    def chain(self) -> Chain:
        """Its geometry, as the kernels want it."""
        return *self.base, 0.0, np.zeros(1, bool), np.array([self.length])

    @property
    def most(self) -> tuple[float, ...]:
        """What its motor can do at most, rad/s."""
        return (self.max_turn,)

    def camera_poses(self, configurations: Configurations) -> np.ndarray:
        """Where it turns, and where the pointer points."""
        poses = super().camera_poses(configurations)
        poses[:, :2] = self.base
        return poses
