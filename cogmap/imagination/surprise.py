"""Surprise: how much a view differs from what was expected, against what is usual there."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, Num

from cogmap.errors import CogmapError
from cogmap.imagination.turning import Painted

FLOOR = 4.0
"""Difference (grey levels) that is usual anywhere."""
DOUBT, CARRIED = 0.5, 0.1
"""Shares of the variance: of what the sources differ by, and of what flow changed of the nearest."""
PATCH = 11 / 360
"""How wide a patch is that is judged as a whole, in turns."""
ALARM = 4.0
"""How many times what one remembered view in 100 reaches a view must surprise to alarm by itself,"""
NOTABLE = 1.5
"""and to be looked at again, and counted where many views tell together that something has changed."""
MANY = 0.05
"""Share of the views that must be notable for this: where nothing has changed hardly any is."""
BEYOND = 0.5
"""How far the plan reaches beyond the remembered places, in units of their extent."""
CELLS = 120
"""Of the plan, along its longer side."""


@dataclass(frozen=True)
class Surprise:
    """What surprises in some views, and where they were seen from."""

    pixels: Float32[np.ndarray, "views height width"]
    """Difference from what is imagined, in units of what is usual there."""
    position: Float[np.ndarray, "views 2"]
    phase: Float[np.ndarray, "views"]
    """Pose at which they were imagined, in the frame of the map."""
    threshold: float
    """Above what is seen where nothing has changed."""
    sense: int
    """Whether phase grows to the left (1) or to the right (−1)."""
    bounds: Float[np.ndarray, "2 2"]
    """Least and largest coordinates of all that is remembered."""

    @property
    def columns(self) -> Float32[np.ndarray, "views width"]:
        """The most surprising pixel of each column."""
        return np.asarray(self.pixels.max(axis=1))

    @property
    def alarms(self) -> Bool[np.ndarray, "views"]:
        """Which views show something that has changed."""
        return np.asarray(self.pixels.max(axis=(1, 2)) > self.threshold)

    @property
    def notable(self) -> Bool[np.ndarray, "views"]:
        """Which views may show something that has changed: no proof, unless there are many."""
        return np.asarray(self.pixels.max(axis=(1, 2)) > NOTABLE / ALARM * self.threshold)

    @property
    def changed(self) -> bool:
        """Whether something has changed: a view alarms, or more are notable than would be by chance."""
        return bool(self.alarms.any() or self.notable.mean() > MANY)

    @property
    def shares(self) -> Float[np.ndarray, "views"]:
        """Share of each view that surprises: nearly all of it after a kidnapping, or when a lamp is out."""
        return np.asarray((self.pixels > self.threshold).mean(axis=(1, 2)))

    def plan(self) -> Plan:
        """Pool what surprises over all views, back-projected onto the map: where something has changed.

        A cell is as surprising as the notable views are in its direction, on average: 1 where each is most
        surprised, and else the square of the ratio to that.

        Raises
        ------
        CogmapError
            When nothing has changed, as far as these views tell.
        """
        if not self.changed:
            raise CogmapError("nothing surprises in these views, so there is nothing to place on the map")
        notable = np.flatnonzero(self.notable)
        low, high = self.bounds
        extent = float((high - low).max())
        low, high = low - BEYOND * extent, high + BEYOND * extent
        cell = float((high - low).max()) / CELLS
        x, y = (np.arange(start, stop, cell) + cell / 2 for start, stop in zip(low, high, strict=True))
        width = self.pixels.shape[2]
        columns = self.columns[notable]
        profiles = np.square(columns / columns.max(axis=1, keepdims=True))
        share = np.zeros((len(y), len(x)))
        poses = zip(self.position[notable], self.phase[notable], profiles, strict=True)
        for position, phase, profile in poses:
            bearing = self.sense * (np.arctan2(y[:, None] - position[1], x - position[0]) - phase)
            # column 0 looks straight back over the left shoulder, the middle one ahead
            share += profile[np.floor((np.pi - bearing) * width / (2 * np.pi)).astype(int) % width]
        return Plan(x, y, share / len(notable))


@dataclass(frozen=True)
class Plan:
    """How surprising each place of the map is."""

    x: Float[np.ndarray, "columns"]
    y: Float[np.ndarray, "rows"]
    """Middles of the cells, in the unit of the map."""
    share: Float[np.ndarray, "rows columns"]
    """How much the notable views are surprised in its direction, from 0 to 1."""

    @property
    def peak(self) -> Float[np.ndarray, "2"]:
        """Where something has changed: the most surprising cell."""
        row, column = np.unravel_index(self.share.argmax(), self.share.shape)
        return np.array([self.x[column], self.y[row]])


def unusual(
    view: Num[np.ndarray, "height width 3"],
    painted: Painted,
    nearest: Float32[np.ndarray, "height width 3"],
) -> Float32[np.ndarray, "height width"]:
    r"""Compare a view with what was imagined, pixel by pixel.

    .. math:: \sqrt{\overline{(v - D)^2} \big/ \overline{\sigma^2}},\quad
        \sigma^2 = \sigma_0^2 + \tfrac12 s^2 + \tfrac1{10} (D - A)^2,

    means over a patch; s is the spread of the sources, and A what the nearest of them shows, turned only.
    Where flow changed little of it, it can hardly be wrong; beside a box it changed all.
    """
    imagined = np.clip(painted.view, 0, 255)
    error = _grey(np.square(imagined - view))
    carried = _grey(np.square(imagined - nearest))
    variance = FLOOR**2 + DOUBT * np.square(painted.spread) + CARRIED * carried
    return np.asarray(np.sqrt(_patches(error) / _patches(variance)), np.float32)


def _grey(
    values: Float32[np.ndarray, "height width 3"],
) -> Float32[np.ndarray, "height width"]:
    """Average over colours; numpy's mean over an axis of three takes seven times as long."""
    return np.asarray((values[:, :, 0] + values[:, :, 1] + values[:, :, 2]) / 3)


def _patches(values: Float32[np.ndarray, "height width"]) -> Float32[np.ndarray, "height width"]:
    half = round(PATCH * values.shape[1] / 2)
    around = cv2.copyMakeBorder(values.astype(np.float32), 0, 0, half, half, cv2.BORDER_WRAP)
    means = cv2.blur(around, (2 * half + 1, 2 * half + 1))[:, half : around.shape[1] - half]
    # sums that run along rows leave less than nothing behind where all is 0
    return np.maximum(means, 0)
