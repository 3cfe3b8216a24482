"""Sampling of points from ranges of parameters, at random or evenly."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from scipy.stats import qmc

from arena.rooms.parts import FrozenModel
from cogmap.errors import CogmapError

MOST = 2**16
"""Points of one sample."""


class Range(FrozenModel):
    """Where a parameter lies; both ends are reached by whole numbers only."""

    low: Annotated[float, Field(allow_inf_nan=False)]
    """The smallest value."""
    high: Annotated[float, Field(allow_inf_nan=False)]
    """The largest."""
    log: bool = False
    """Whether equal ratios are equally likely, and not equal differences."""
    integer: bool = False
    """Whether whole numbers only."""

    def at(self, share: float) -> float | int:
        """Give the value below which this share, in [0, 1), of all values lies."""
        end = self.high + 1 if self.integer else self.high
        if self.log:
            value = math.exp(math.log(self.low) + share * (math.log(end) - math.log(self.low)))
        else:
            value = self.low + share * (end - self.low)
        return math.floor(min(value, self.high)) if self.integer else value

    def check(self, name: str) -> None:
        """Raise unless there is something between the ends."""
        if self.low >= self.high:
            raise CogmapError(f"the range of {name!r} is from {self.low:g} to {self.high:g}; give low < high")
        if self.log and self.low <= 0:
            raise CogmapError(f"the range of {name!r} is from {self.low:g}; on a log scale give low above 0")
        if self.integer and (self.low % 1 or self.high % 1):
            raise CogmapError(
                f"the range of {name!r} is from {self.low:g} to {self.high:g}; give whole numbers as its ends"
            )


class Sample(FrozenModel):
    """How many points are drawn, and from where."""

    points: Annotated[int, Field(strict=True, ge=1, le=MOST)]
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
        drawn = [
            {name: span.at(share) for (name, span), share in zip(self.ranges.items(), row, strict=True)}
            for row in shares.tolist()
        ]
        return list({tuple(point.values()): point for point in drawn}.values())
