"""Sampling of points from ranges of parameters, at random or evenly."""

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, FiniteFloat
from scipy.stats import qmc

from arena.rooms.parts import FrozenModel
from cogmap.errors import CogmapError


class Range(FrozenModel):
    """Where a parameter lies; both ends are reached by whole numbers only."""

    low: FiniteFloat
    """The smallest value."""
    high: FiniteFloat
    """The largest."""
    log: bool = False
    """Whether equal ratios are equally likely, and not equal differences."""
    integer: bool = False
    """Whether whole numbers only."""

    def at(self, share: float) -> float | int:
        """Give the value below which this share, in [0, 1), of all values lies."""
        onto, back = (math.log, math.exp) if self.log else (float, float)
        low, end = onto(self.low), onto(self.high + self.integer)
        value = back(low + share * (end - low))
        return math.floor(min(value, self.high)) if self.integer else value

    def check(self, name: str) -> None:
        """Raise unless there is something between the ends."""
        begin = f"the range of {name!r} is from {self.low:g}"
        if self.low >= self.high:
            raise CogmapError(f"{begin} to {self.high:g}; give low < high")
        if self.log and self.low <= 0:
            raise CogmapError(f"{begin}; on a log scale give low above 0")
        if self.integer and (self.low % 1 or self.high % 1):
            raise CogmapError(f"{begin} to {self.high:g}; give whole numbers as its ends")


class Sample(FrozenModel):
    """How many points are drawn, and from where."""

    points: Annotated[int, Field(strict=True, ge=1, le=2**16)]
    """How many; fewer where points of whole numbers coincide."""
    ranges: Annotated[dict[str, Range], Field(min_length=1)]
    """By parameter."""
    method: Literal["sobol", "random"] = "sobol"
    """A scrambled Sobol sequence fills the ranges evenly; at random all points are independent."""
    seed: Annotated[int, Field(strict=True, ge=0)] = 0
    """Of the drawing, not of the experiments."""

    def draw(self) -> list[dict[str, float | int]]:
        """Draw the points, each a value by parameter.

        References
        ----------
        Owen (1998), Scrambling Sobol' and Niederreiter-Xing points, Journal of Complexity 14.
        """
        for name, span in self.ranges.items():
            span.check(name)
        rng = np.random.default_rng(self.seed)
        if self.method == "sobol":
            # Whole powers of two only are balanced; what comes first of one is the same for fewer points.
            power = math.ceil(math.log2(self.points))
            shares = qmc.Sobol(len(self.ranges), rng=rng).random_base2(power)[: self.points]
        else:
            shares = rng.random((self.points, len(self.ranges)))
        drawn = (tuple(map(Range.at, self.ranges.values(), row)) for row in shares.tolist())
        return [dict(zip(self.ranges, point, strict=True)) for point in dict.fromkeys(drawn)]
