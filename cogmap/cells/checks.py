"""The edge where bad samples are refused."""

from __future__ import annotations

import numpy as np

from cogmap.errors import CogmapError


def check_array(name: str, array: np.ndarray, shape: tuple[int | None, ...]) -> None:
    """Refuse an array that is not of this shape or not finite; None stands for any length but zero.

    Raises
    ------
    CogmapError
        With the name, the shape given and the shape expected.
    """
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
