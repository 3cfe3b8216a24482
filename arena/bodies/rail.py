"""The rail: an eye that goes to and fro and never turns."""

import numpy as np

from arena.bodies.base import Axis
from arena.bodies.jointed import Jointed, Metres, Point, Speed
from arena.bodies.linkage import Chain


class Rail(Jointed):
    """A carriage on a straight rail: one line. Its eye looks along the rail.

    Parameters
    ----------
    length
        How far the carriage goes, m.
    start
        Where it is at 0, m.
    heading
        Where it goes from there, rad.
    width
        Of the carriage, m.
    max_speed
        m/s.
    height, slip, motor_gains
        See `arena.bodies.jointed.Jointed`.

    Raises
    ------
    ArenaError
        For parameters out of range.
    """

    length: Metres = 3.0
    start: Point = (-1.5, 0.0)
    heading: float = 0.0
    width: Metres = 0.16
    max_speed: Speed = 0.65

    @property
    def axes(self) -> tuple[Axis, ...]:
        """Its one joint."""
        return (Axis("position", "line", "m", (0.0, self.length)),)

    @property
    def radius(self) -> float:
        """Half of how thick the carriage is, m."""
        return self.width / 2

    @property
    def chain(self) -> Chain:
        """Its geometry, as the kernels want it."""
        return *self.start, self.heading, np.ones(1, bool), np.zeros(1)

    @property
    def most(self) -> tuple[float, ...]:
        """What its motor can do at most, m/s."""
        return (self.max_speed,)
