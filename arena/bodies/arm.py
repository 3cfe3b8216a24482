"""The arm: links in a row on a fixed base, with a hand at the end that may bear the eye."""

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from arena.bodies.base import Axis
from arena.bodies.jointed import Jointed, Metres, Point, Speed
from arena.bodies.linkage import Chain

_Range = tuple[float, float]

HALF_RANGE = 2 * math.pi / 3
"""How far a joint goes to either side whose limits are not told in numbers, rad."""


class Arm(Jointed):
    """An arm of two to four links that turn in one plane, with its hand at the end of the last.

    The first joint's angle is that of the first link from the x-axis, each next one's that of its link from
    the link before. Links pass over each other, as they do on an arm whose joints are stacked. A camera on
    the hand looks along the last link; an `Overhead` watches the arm from above.

    Parameters
    ----------
    links
        Their lengths, m, from the base on.
    limits
        First and last angle (rad) of each joint, None where it turns all round; or "none", "one" (the last
        joint goes 120° to either side) or "both" (all do).
    base
        Where the first joint is, m.
    width
        Of the links, m.
    max_turn
        Of each joint, rad/s.
    height, slip, motor_gains
        See `arena.bodies.jointed.Jointed`.

    Raises
    ------
    ArenaError
        For parameters out of range.
    """

    links: Annotated[tuple[Metres, ...], Field(min_length=2, max_length=4)] = (1.0, 0.8)
    limits: Literal["none", "one", "both"] | tuple[_Range | None, ...] = "none"
    base: Point = (0.0, 0.0)
    width: Metres = 0.16
    max_turn: Speed = np.pi / 2

    @model_validator(mode="after")
    def _one_range_each(self) -> "Arm":
        if len(self._limits) != len(self.links):
            raise ValueError(f"{len(self._limits)} limits for {len(self.links)} links; give one each")
        for ends in self._limits:
            if ends is not None and not ends[0] < ends[1] <= ends[0] + 2 * np.pi:
                raise ValueError(f"limits {ends} rad; give the lower first, and no more than a turn")
        return self

    @property
    def _limits(self) -> tuple[_Range | None, ...]:
        if not isinstance(self.limits, str):
            return self.limits
        count = len(self.links)
        free = {"none": count, "one": count - 1, "both": 0}[self.limits]
        return (None,) * free + ((-HALF_RANGE, HALF_RANGE),) * (count - free)

    @property
    def axes(self) -> tuple[Axis, ...]:
        """Its joints, from the base on."""
        return tuple(
            Axis(f"joint_{k}", "circle" if ends is None else "line", "rad", ends)
            for k, ends in enumerate(self._limits, start=1)
        )

    @property
    def radius(self) -> float:
        """Half of how thick its links are, m."""
        return self.width / 2

    @property
    def chain(self) -> Chain:
        """Its geometry, as the kernels want it."""
        return *self.base, 0.0, np.zeros(len(self.links), bool), np.array(self.links)

    @property
    def most(self) -> tuple[float, ...]:
        """What each motor can do at most, rad/s."""
        return (self.max_turn,) * len(self.links)
