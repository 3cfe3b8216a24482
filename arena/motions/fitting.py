"""Fitting a path into a room by its robust extremes: a place that a tracker made up does not decide."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float
from shapely.geometry.base import BaseGeometry

from arena.recordings.lost_samples import too_fast
from arena.recordings.tracks import RecordedPath

TAIL = 0.005
"""Share of the samples at either end of an axis by which its range is not taken."""
ROUNDS = 20
"""How often at most scale and speed are agreed on."""


class Fitted(NamedTuple):
    """A path that just fits into a room."""

    positions: Float[np.ndarray, "samples 2"]
    """m; NaN where the animal was lost or its place left out."""
    scale: float
    """m per unit of the recorded positions."""
    left_out: Bool[np.ndarray, " samples"]
    """Positions that were recorded, and are far from all others or, where no speed is told, doubtful."""
    too_fast: Bool[np.ndarray, " samples"]
    """Positions that were recorded, and that the animal is too slow for."""


def fitted(recorded: RecordedPath, free: BaseGeometry, fastest: float | None) -> Fitted:
    """Scale and move a path so that it just fits the box around a free space.

    Its extremes are the outermost positions but for doubtful ones, and for those that lie by more than the
    whole range of the middle 99 % beyond it. Both are left out; a speed that is told judges doubtful ones.

    Parameters
    ----------
    recorded
        The path, in whatever unit it is.
    free
        Where the body may be, m.
    fastest
        Speed that the animal cannot exceed in the room, m/s; since the scale hangs on who is left out, and
        speeds on the scale, the two are found in turns.
    """
    known = np.isfinite(recorded.positions).all(axis=1)
    positions = np.where(known[:, None], recorded.positions, np.nan)
    doubtful = known & recorded.doubtful
    left_out = known & _far(positions, known & ~doubtful)
    if fastest is None:
        left_out |= doubtful
    positions[left_out] = np.nan
    room = np.reshape(free.bounds, (2, 2))
    fast = np.zeros(len(positions), dtype=bool)
    trusted = np.where(doubtful[:, None], np.nan, positions)
    for _ in range(ROUNDS):
        low, high = np.nanmin(trusted, axis=0), np.nanmax(trusted, axis=0)
        sides = zip(room[1] - room[0], high - low, strict=True)
        scale = float(min((side / length for side, length in sides if length > 0), default=1.0))
        if fastest is None:
            break
        more = too_fast(recorded.times, positions * scale, fastest)
        positions[more] = np.nan
        fast |= more
        if not more.any() and trusted is positions:
            break
        trusted = positions
    placed = (positions - (low + high) / 2) * scale + room.mean(axis=0)
    return Fitted(placed, scale, left_out, fast)


def _far(
    positions: Float[np.ndarray, "samples 2"], trusted: Bool[np.ndarray, " samples"]
) -> Bool[np.ndarray, " samples"]:
    """Find positions far beyond the range that trusted ones have for the most part."""
    low, high = np.quantile(positions[trusted], [TAIL, 1 - TAIL], axis=0)
    # On a narrow track the long side is the measure for both.
    margin = (high - low).max()
    with np.errstate(invalid="ignore"):
        far: np.ndarray = ((positions < low - margin) | (positions > high + margin)).any(axis=1)
    return far
