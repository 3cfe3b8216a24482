"""How a tracker's file is to be read: the options of `arena.read_track` and `arena.Replay`."""

from collections.abc import Iterable
from math import hypot, isnan
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from arena.settings import Settings, Share

Above = Annotated[float, Field(ge=1e-6, le=1e6)]
Name = Annotated[str, Field(min_length=1, coerce_numbers_to_str=True)]
Pair = tuple[float, float]


def _on_both_axes(value: Any) -> Any:
    return (value, value) if isinstance(value, int | float | np.number) else value


def _listed(value: Any) -> Any:
    """Take one number for a list of one; NaN is missing in any case, and equals nothing."""
    if isinstance(value, int | float | np.number):
        value = (value,)
    if isinstance(value, Iterable) and not isinstance(value, str):
        return tuple(item for item in value if not (isinstance(item, float) and isnan(item)))
    return value


class TrackFormat(Settings):
    """Which columns of a tracker's file are what, in which units, and what of it is lost.

    Parameters
    ----------
    x, y, t, heading
        Names of columns. None takes those of that name, in any case; `time` for `t`, and `heading_deg` for
        `heading`. In tables of DeepLabCut and SLEAP the columns are called `nose.x`, `nose.y`.
    heading_in
        "rad" or "deg"; None goes by the name of the column, which ends in `deg` then. Counter-clockwise from
        +x as in the file; with `y_down` as an image has it, clockwise.
    bodypart
        Of tables of DeepLabCut or SLEAP, `rat1.nose` where they tell of several animals. None where there is
        only one.
    individual
        The animal, of tables of SLEAP that hold several: a value of their column `track`.
    likelihood, least_likelihood
        The column of it, None for that of the body part (`nose.likelihood`, `nose.score`), and the least that
        a sample must have, in [0, 1]; those below are lost. None keeps all.
    rate
        Hz, in place of times in s: how many units of the column make a second. It is one of frame numbers
        (`frame`, `frame_idx`) or `t`, and may count milliseconds (1000); without one every row is a frame.
    scale
        m per unit of the file, one for both axes or one for each.
    calibration
        In place of `scale` two points, in units of the file, and how far they are apart, m:
        ((80, 40), (560, 40), 1.2).
    y_down
        Whether y grows downwards, as in images; y of the track is −y of the file, in m.
    missing
        What the tracker writes where it lost the animal, in units of the file: a number that both x and y are
        then, (0,) or (-1, 1023), or pairs, ((1023, 767),). NaN and empty cells are missing in any case, and
        nothing else is unless told: an animal may be at (0, 0). A number that is no angle is a missing
        heading, too.
    fastest
        Speed that the animal cannot exceed, m/s: the fewest samples are judged lost with which it does not.

    Raises
    ------
    ArenaError
        For parameters out of range or at odds with each other.
    """

    x: Name | None = None
    y: Name | None = None
    t: Name | None = None
    heading: Name | None = None
    heading_in: Literal["rad", "deg"] | None = None
    bodypart: Name | None = None
    individual: Name | None = None
    likelihood: Name | None = None
    least_likelihood: Share | None = None
    rate: Above | None = None
    scale: Annotated[tuple[Above, Above], BeforeValidator(_on_both_axes)] = (1.0, 1.0)
    calibration: tuple[Pair, Pair, Above] | None = None
    y_down: bool = False
    missing: Annotated[tuple[float | Pair, ...], BeforeValidator(_listed)] = ()
    fastest: Above | None = None

    @model_validator(mode="after")
    def _agree_on_columns(self) -> "TrackFormat":
        if self.bodypart is not None and (self.x, self.y) != (None, None):
            raise ValueError("bodypart names the columns of x and y; leave them out")
        if (self.x is None) != (self.y is None):
            raise ValueError("only one of x and y is named; name both")
        if self.calibration is not None and self.scale != (1.0, 1.0):
            raise ValueError("both scale and calibration are given; choose one")
        if self.calibration is not None and self.calibration[0] == self.calibration[1]:
            raise ValueError("the two points of calibration are one; give two that are apart")
        return self

    @property
    def metres_per_unit(self) -> Pair:
        """Along x and y of the file."""
        if self.calibration is None:
            return self.scale
        (ax, ay), (bx, by), metres = self.calibration
        return (metres / hypot(bx - ax, by - ay),) * 2
