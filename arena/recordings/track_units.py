"""Units of a track: what cannot be seconds, nor radians, nor degrees, and the way to metres."""

from pathlib import Path

import numpy as np
from jaxtyping import Float

from arena.errors import ArenaError

FEWEST = 20
"""Samples that must be there for their units to be judged."""
SLOW = 0.025
"""Share of its range that an animal passes in a second at least, for the most part: frames are shorter."""
SPINNING = 20.0
"""Turn rate that no head keeps up, rad/s."""
ROUND = 2 * np.pi * 1.01
"""What wrapped radians stay within, and a little for rounding."""

Times = Float[np.ndarray, " samples"]
Positions = Float[np.ndarray, "samples 2"]
Headings = Float[np.ndarray, " samples"]


def check_seconds(path: Path, name: str, times: Times, positions: Positions) -> None:
    """Refuse times that count frames or milliseconds: whole ones, in which the animal hardly moves.

    Raises
    ------
    ArenaError
        With what to pass.
    """
    known = np.isfinite(positions).all(axis=1)
    if known.sum() < FEWEST or (times % 1 != 0).any():
        return
    place = positions[known]
    step = np.hypot(*np.diff(place, axis=0).T)
    extent = np.hypot(*(np.quantile(place, 0.99, axis=0) - np.quantile(place, 0.01, axis=0)))
    if not step.any() or np.median(step[step > 0]) > SLOW * extent:
        return
    usual = np.median(np.diff(times))
    raise ArenaError(
        f"{path}: {name} is whole and goes by {usual:g}, in which the animal moves "
        f"{np.median(step[step > 0]) / extent:.1%} of its range: it does not count seconds; pass rate=, how "
        "many make a second (the frame rate, 1000 for milliseconds, or 1 if they are seconds indeed)"
    )


def to_radians(path: Path, name: str, headings: Headings, times: Times, *, degrees: bool) -> Headings:
    """Give headings in radians, as they are wrapped or not.

    Radians lie within ±2π, or are unwrapped: they do not step by more than π, and few heads turn faster than
    `SPINNING`. Degrees that all lie within ±2π, go nearly round there and step by more than π are radians.

    Raises
    ------
    ArenaError
        For headings that are in the other unit, or in neither.
    """
    known = np.isfinite(headings)
    told = headings[known]
    if degrees:
        seem = len(told) >= FEWEST and np.ptp(told) > 1.5 * np.pi and np.abs(told).max() <= ROUND
        if seem and (np.abs(np.diff(told)) > np.pi).any():
            raise ArenaError(
                f"{path}: {name} goes from {told.min():.3g} to {told.max():.3g} and jumps by nearly 2π: "
                "these are radians, not degrees; pass heading_in='rad', or call the column heading"
            )
        radians: Headings = np.deg2rad(headings)
        return radians
    if len(told) and np.abs(told).max() > ROUND:
        step = np.abs(np.diff(told))
        rate = step / np.diff(times[known])
        if (step > np.pi).any() or (len(told) >= FEWEST and np.quantile(rate, 0.9) > SPINNING):
            raise ArenaError(
                f"{path}: {name} goes from {told.min():.4g} to {told.max():.4g} in steps of up to "
                f"{step.max():.4g}, which are no radians; pass heading_in='deg' (or call the column "
                "heading_deg) if these are degrees, and missing= if some number stands for lost ones"
            )
    return headings


def to_metres(
    positions: Positions, headings: Headings | None, metres: tuple[float, float], *, y_down: bool
) -> tuple[Positions, Headings | None]:
    """Scale a track to metres, y upwards, and turn its headings with it.

    Parameters
    ----------
    positions, headings
        In units of the file, and rad in those units: pixels that are no squares bend angles.
    metres
        Per unit along x and y.
    y_down
        Whether y grows downwards.
    """
    along = np.array([metres[0], -metres[1] if y_down else metres[1]])
    if headings is not None and metres[0] != metres[1]:
        headings = np.arctan2(metres[1] * np.sin(headings), metres[0] * np.cos(headings))
    if headings is not None and y_down:
        headings = -headings
    return positions * along, headings
