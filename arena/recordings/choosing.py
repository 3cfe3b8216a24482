"""Choosing views: what may stand in the brackets behind a recording, and what is wrong with the rest."""

import operator
from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol, SupportsIndex, runtime_checkable

import numpy as np
from jaxtyping import Bool, Float32, Float64, Int, Shaped, UInt8

from arena.errors import ArenaError, NoSuchViewError


@runtime_checkable
class WholeNumber(Protocol):
    """Integers of Python and of numpy; an array has an `__index__`, too, but no denominator."""

    @property
    def denominator(self) -> int:
        """1."""

    def __index__(self) -> int:
        """Turn into an integer of Python."""


@runtime_checkable
class AsArray(Protocol):
    """Arrays and what turns into one: tensors, the series of pandas."""

    def __array__(self) -> np.ndarray:
        """Turn into an array."""


Several = slice | Sequence[int] | Sequence[bool] | AsArray
"""A slice, numbers of views or a mask, one truth value a view; numbers below 0 count from the end."""


class Moment(NamedTuple):
    """One view and what was recorded with it, named as in the recording: `rec[3].poses` is `rec.poses[3]`."""

    views: UInt8[np.ndarray, "height width 3"]
    times: float
    """s."""
    odours: Float32[np.ndarray, " odorants"] | None
    poses: Float64[np.ndarray, "3"] | None
    commands: Float64[np.ndarray, " commands"] | None
    joints: Float64[np.ndarray, " joints"] | None
    signals: dict[str, Shaped[np.ndarray, "..."] | np.generic]


def one(key: Any, count: int) -> int | None:
    """Tell which view out of this many an integer of any kind means; None when it is no integer.

    Raises
    ------
    NoSuchViewError
        Past either end.
    """
    # Of True and of a row of one value, too, `index` makes a number.
    if isinstance(key, bool | np.bool_) or getattr(key, "ndim", None) or not isinstance(key, SupportsIndex):
        return None
    try:
        number = operator.index(key)
    except TypeError:
        return None
    if not -count <= number < count:
        raise NoSuchViewError(_outside(number, count))
    return number % count


def several(key: Any, count: int) -> slice | Bool[np.ndarray, " views"] | Int[np.ndarray, " chosen"]:
    """Make a slice, a mask or integers for numpy out of what chooses among this many views.

    Raises
    ------
    NoSuchViewError
        For a number past either end.
    ArenaError
        For what chooses no views, and for a mask of another length.
    """
    if isinstance(key, slice):
        return key
    chosen = np.empty(0, int) if isinstance(key, list) and not key else np.asarray(key)
    if isinstance(key, tuple) or chosen.ndim != 1 or chosen.dtype.kind not in "biu":
        plain = isinstance(key, tuple) or chosen.ndim == 0
        given = repr(key) if plain else f"{chosen.dtype} of shape {chosen.shape}"
        raise ArenaError(f"{given} chooses no views; give a number, a slice, a list of numbers or a mask")
    if chosen.dtype.kind == "b":
        if len(chosen) != count:
            raise ArenaError(
                f"the mask has {len(chosen)} values for {count} views; give one truth value a view"
            )
        return chosen
    outside = (chosen < -count) | (chosen >= count)
    if outside.any():
        raise NoSuchViewError(_outside(int(chosen[outside][0]), count))
    return chosen.astype(np.intp)


def _outside(number: int, count: int) -> str:
    return f"there is no view {number} among {count}; give a number from {-count} to {count - 1}"
