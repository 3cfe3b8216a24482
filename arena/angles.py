"""Angles in radians: wrapped to (−π, π], and the turn from one heading to another."""

from __future__ import annotations

import math
from typing import TypeVar

import numpy as np

Angle = TypeVar("Angle", float, np.ndarray)


def wrap_angle(angle: Angle) -> Angle:
    """Wrap angles (rad) to (−π, π], a number or an array of any shape.

    π − (π − θ) mod 2π. It keeps float32 as it is, NaN as NaN, and rounds to the spacing of numbers near π.
    """
    turn = (math.pi - angle) % (2 * math.pi)
    # Where θ is one rounding beyond π the remainder rounds to a whole turn, which would wrap to −π.
    return math.pi - turn * (turn < 2 * math.pi)


def signed_turn(heading: float, goal: float) -> float:
    """By how much to turn from one heading to another (rad), the short way; leftward is positive.

    In [−π, π]: half a turn goes the way that goal − heading points. The remainder of IEEE 754 is exact,
    unlike `wrap_angle`, and a walk adds these up.
    """
    return math.remainder(goal - heading, 2 * math.pi)
