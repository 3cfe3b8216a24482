"""Checks where arrays and counts enter."""

import numpy as np
from jaxtyping import Float32
from numpy.typing import ArrayLike

from cogmap.errors import CogmapError


def checked_count(name: str, value: object, least: int = 1) -> int:
    """Return a whole number of at least `least`, or say what is wrong with it."""
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < least:
        raise CogmapError(f"{name} is {value!r}; give a whole number of at least {least}")
    return int(value)


def check_choice(name: str, value: str, choices: tuple[str, ...]) -> None:
    """Raise unless a name is one of those on offer."""
    if value not in choices:
        raise CogmapError(f"unknown {name} {value!r}; choose one of {', '.join(choices)}")


def check_views(views: object, shape: tuple[int, ...] | None = None) -> None:
    """Raise unless `views` are uint8 images (views, height, width, 3), of `shape` when it is given."""
    found, dtype = getattr(views, "shape", None), getattr(views, "dtype", None)
    if found is None or len(found) != 4 or found[3] != 3 or dtype != np.uint8:
        what = type(views).__name__ if found is None else f"{dtype} of shape {tuple(found)}"
        raise CogmapError(f"views are {what}; give uint8 images of shape (views, height, width, 3)")
    if not found[0]:
        raise CogmapError("there are no views; record at least one")
    if shape is not None and tuple(found[1:]) != tuple(shape):
        raise CogmapError(
            f"views are {found[1]}×{found[2]} pixels but this map was learnt from {shape[0]}×{shape[1]}; "
            "record with the camera the map was learnt with"
        )


def log_odours(
    odours: ArrayLike | None, *, views: int | None = None, odorants: int | None = None
) -> Float32[np.ndarray, "views odorants"]:
    """Take the logarithm of concentrations, (views, odorants), all finite and > 0."""
    if odours is None:
        raise CogmapError(
            "there are no odours, and a map learns places from them; use a recording that has them"
        )
    array = np.asarray(odours)
    if array.ndim != 2 or array.shape[1] < 1 or array.dtype.kind not in "fiu":
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
        raise CogmapError(f"{name} has shape {array.shape}, not ({wanted}); give one row per view")
    if not np.isfinite(array).all():
        bad = np.unique(np.nonzero(~np.isfinite(array))[0])
        raise CogmapError(
            f"{name} is not finite in {bad.size} of {len(array)} views, first in view {bad[0]}; "
            "leave those views out"
        )


def check_samples(
    rates: np.ndarray, *, positions: np.ndarray | None = None, headings: np.ndarray | None = None
) -> None:
    """Refuse rates (views, cells) that are not finite and nonnegative, and truth that does not fit them.

    Raises
    ------
    CogmapError
        For a wrong shape, NaN, infinity or a negative rate.
    """
    check_array("rates", rates, (None, None))
    if positions is not None:
        check_array("positions", positions, (len(rates), 2))
    if headings is not None:
        check_array("headings", headings, (len(rates),))
    if rates.min() < 0:
        raise CogmapError(f"rates go down to {rates.min():g} Hz, and a rate is never negative; rectify them")
