"""Checks where arrays and numbers enter: whatever holds numbers is taken, and leaves as a plain array."""

from collections.abc import Sequence
from numbers import Real
from typing import Any, TypeAlias

import numpy as np
from jaxtyping import Float, Float32
from numpy.typing import ArrayLike

from cogmap.errors import CogmapError

AnyArray: TypeAlias = ArrayLike | Sequence[Any]
"""Numbers as people have them: arrays, nested lists, DataFrames, Series, tensors, what has `__array__`."""
Whole: TypeAlias = int | np.integer
"""A whole number, Python's or numpy's."""
MOST_TURN = 4 * np.pi
"""Headings beyond two turns either way (rad) may be degrees, or unwrapped: nobody can tell which."""


def checked_count(name: str, value: object, least: int = 1) -> int:
    """Return a whole number of at least `least`, or say what is wrong with it."""
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < least:
        raise CogmapError(f"{name} is {value!r}; give a whole number of at least {least}")
    return int(value)


def checked_number(name: str, value: object, least: float = 0.0) -> float:
    """Return a finite number of at least `least`, or say what is wrong with it."""
    sound = isinstance(value, Real) and not isinstance(value, bool)
    if not sound or not least <= float(value) < np.inf:  # type: ignore[arg-type]
        raise CogmapError(f"{name} is {value!r}; give a number of at least {least:g}")
    return float(value)  # type: ignore[arg-type]


def check_choice(name: str, value: str, choices: tuple[str, ...]) -> None:
    """Raise unless a name is one of those on offer."""
    if value not in choices:
        raise CogmapError(f"unknown {name} {value!r}; choose one of {', '.join(choices)}")


def checked_views(views: Any, shape: tuple[int, ...] | None = None) -> Any:
    """Pass uint8 images (views, height, width, 3) on, of `shape` when it is given.

    Tensors and lists of images become arrays. What is lazy, with a shape, a dtype and slices that are arrays,
    stays so.

    Raises
    ------
    CogmapError
        For anything else: it says what was found, and what to do about it.
    """
    if isinstance(views, list | tuple) or hasattr(views, "detach"):
        views = as_array("views", views)
    check_views(views, shape)
    return views


def check_views(views: object, shape: tuple[int, ...] | None = None) -> None:
    """Raise unless `views` are uint8 images (views, height, width, 3), of `shape` when it is given."""
    found, dtype = getattr(views, "shape", None), getattr(views, "dtype", None)
    if found is None or len(found) != 4 or found[3] != 3 or dtype != np.uint8:
        what = type(views).__name__ if found is None else f"{dtype} of shape {tuple(found)}"
        hint = "" if found is None else _views_hint(tuple(found), np.dtype(dtype))
        raise CogmapError(f"views are {what}; give uint8 images of shape (views, height, width, 3){hint}")
    if not found[0]:
        raise CogmapError("there are no views; record at least one")
    if shape is not None and tuple(found[1:]) != tuple(shape):
        raise CogmapError(
            f"views are {found[1]}×{found[2]} pixels but this map was learnt from {shape[0]}×{shape[1]}; "
            "record with the camera the map was learnt with"
        )


def _views_hint(shape: tuple[int, ...], dtype: np.dtype) -> str:
    """Say what images that are not (views, height, width, 3) uint8 probably are."""
    if len(shape) == 4 and shape[1] == 3 != shape[3]:
        return ": colours come last, as numpy.moveaxis(views, 1, -1) puts them"
    if len(shape) == 3 and shape[2] == 3:
        return ": of a single view views[None]"
    if len(shape) == 3 or shape[-1:] == (1,):
        return ": of grey images each grey three times"
    if len(shape) == 4 and shape[3] == 4:
        return ": the fourth channel is left out by views[..., :3]"
    if dtype.kind == "f":
        return ": of intensities in [0, 1] numpy.rint(255 * views).astype(numpy.uint8)"
    return ""


def log_odours(
    odours: AnyArray | None, *, views: int | None = None, odorants: int | None = None
) -> Float32[np.ndarray, "views odorants"]:
    """Take the logarithm of concentrations, (views, odorants), all finite and > 0."""
    if odours is None:
        raise CogmapError(
            "there are no odours, and a map learns places from them; use a recording that has them"
        )
    array = as_array("odours", odours)
    if array.ndim != 2 or array.shape[1] < 1 or array.dtype.kind == "b":
        raise CogmapError(
            f"odours are {array.dtype} of shape {array.shape}; give concentrations of shape (views, odorants)"
        )
    if views is not None and len(array) != views:
        raise CogmapError(f"there are {views} views but {len(array)} odours; give one row of odours per view")
    if odorants is not None and array.shape[1] != odorants:
        raise CogmapError(
            f"there are {array.shape[1]} odorants but this map knows {odorants}; "
            "use the room with the same odour sources"
        )
    bad = np.flatnonzero(~(np.isfinite(array) & (array > 0)).all(axis=1))
    if len(bad):
        raise CogmapError(
            f"odours of view {bad[0]} are {array[bad[0]]}; concentrations must be finite and above 0: "
            "leave such views out"
        )
    return np.log(array.astype(np.float32))


def as_array(name: str, values: object) -> np.ndarray:
    """Make an array of whatever holds numbers, of their own type; what is masked or missing becomes NaN.

    Raises
    ------
    CogmapError
        For what holds none, and rows of unequal length.
    """
    if values is None:
        raise CogmapError(f"there are no {name}; use a recording that has them")
    try:
        array = _unwrapped(values)
    except (TypeError, ValueError, RuntimeError) as error:
        raise CogmapError(f"{name} cannot be made an array: {error}") from None
    if array.dtype.kind not in "biuf":
        raise CogmapError(f"{name} holds {_kind(values, array)}; give numbers alone")
    # compiled loops and torch know the processor's own order of bytes only
    return array if array.dtype.isnative else array.astype(array.dtype.newbyteorder("="))


def _unwrapped(values: Any) -> np.ndarray:
    if isinstance(values, list | tuple) and any(hasattr(item, "detach") for item in values):
        values = [_unwrapped(item) for item in values]
    if hasattr(values, "detach"):  # a tensor, which may be on another device or remember where it came from
        values = values.detach().cpu()
    if isinstance(values, np.ma.MaskedArray):
        return np.ma.filled(values.astype(float), np.nan)
    array = np.asarray(values)
    if array.dtype == object and hasattr(values, "to_numpy"):  # of pandas, with missing values of its own
        array = values.to_numpy(dtype=float, na_value=np.nan)
    return array


def _kind(values: object, array: np.ndarray) -> str:
    """Say what an array that is not of numbers holds."""
    if array.ndim == 0 and array.dtype == object:
        return f"a {type(values).__name__}"
    return {"c": "complex numbers", "M": "dates", "m": "durations"}.get(array.dtype.kind, "text or objects")


def as_floats(array: np.ndarray) -> Float[np.ndarray, "..."]:
    """Pass float32 and float64 on; make all other numbers float64."""
    return array if array.dtype in (np.float32, np.float64) else array.astype(np.float64)


def checked_array(
    name: str, values: AnyArray | None, shape: tuple[int | None, ...]
) -> Float[np.ndarray, "..."]:
    """Make a float array of whatever holds numbers, and refuse it as `check_array` does.

    Raises
    ------
    CogmapError
        For no numbers, another shape, and what is not finite.
    """
    array = as_floats(as_array(name, values))
    check_array(name, array, shape)
    return array


def checked_rates(rates: AnyArray) -> Float[np.ndarray, "views cells"]:
    """Make an array of rates or spikes, all finite and at least 0.

    Raises
    ------
    CogmapError
        For a wrong shape, NaN, infinity or a negative rate.
    """
    array = checked_array("rates", rates, (None, None))
    if array.min() < 0:
        raise CogmapError(f"rates go down to {array.min():g} Hz, and a rate is never negative; rectify them")
    return array


def checked_headings(headings: AnyArray | None, views: int | None = None) -> Float[np.ndarray, "views"]:
    """Make an array of headings in rad, within two turns either way (`MOST_TURN`).

    Beyond that they may be degrees or unwrapped; a guess would be wrong in silence.

    Raises
    ------
    CogmapError
        For a wrong shape, NaN or infinity, and headings that are hardly rad.
    """
    array = checked_array("headings", headings, (views,))
    low, high = array.min(), array.max()
    if max(-low, high) > MOST_TURN:
        likely = "they look like degrees" if low >= -361 and high <= 361 else "they may be unwrapped"
        raise CogmapError(
            f"headings go from {low:g} to {high:g}, farther than two turns in rad: {likely}; give "
            "numpy.deg2rad(headings) of degrees, numpy.angle(numpy.exp(1j * headings)) of unwrapped radians"
        )
    return array


def check_array(name: str, array: np.ndarray | None, shape: tuple[int | None, ...]) -> None:
    """Refuse an array that is not of this shape or not finite; None stands for any length but zero.

    Raises
    ------
    CogmapError
        With the name, the shape given and the shape expected.
    """
    if array is None:
        raise CogmapError(f"there are no {name}; use a recording that has them")
    fits = array.ndim == len(shape) and all(
        given > 0 if wanted is None else given == wanted
        for given, wanted in zip(array.shape, shape, strict=True)
    )
    if not fits:
        wanted = ", ".join("any" if length is None else str(length) for length in shape)
        hint = _shape_hint(name, array.shape, shape)
        raise CogmapError(f"{name} has shape {array.shape}, not ({wanted}); give one row per view{hint}")
    if not np.isfinite(array).all():
        bad = np.unique(np.nonzero(~np.isfinite(array))[0])
        raise CogmapError(
            f"{name} is not finite in {bad.size} of {len(array)} views, first in view {bad[0]}; "
            "leave those views out"
        )


def _shape_hint(name: str, found: tuple[int, ...], wanted: tuple[int | None, ...]) -> str:
    """Say what an array of another shape probably is."""
    if len(found) == 1 and len(wanted) == 2:
        return f": of one column {name}[:, None]"
    if len(found) == len(wanted) == 2:
        turned = zip(found[::-1], wanted, strict=True)
        if found[1] == 3 and wanted[1] == 2:
            return f": of poses {name}[:, :2]"
        if wanted != (None, None) and all(length in {None, given} for given, length in turned):
            return f": it fits when it is turned, {name}.T"
    if len(found) == 2 and found[1] == 1 and len(wanted) == 1:
        return f": {name}[:, 0]"
    return ""
