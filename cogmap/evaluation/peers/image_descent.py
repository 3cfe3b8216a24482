"""Descent on image differences, the peer: homing by how unlike the goal's image what is seen is."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, UInt8
from scipy import fft

from arena.motions.policy import Sensed
from cogmap.control.steering import Steering

GOLDEN = np.pi * (3 - np.sqrt(5))
"""Turn after a step that led uphill, rad: the next ones fill the circle evenly."""
LAST = 0.02
"""Share of a decision's way that ends the descent."""
ALIGNED = np.deg2rad(0.5)
"""Turn from the goal's view at which it stops."""


class Difference(NamedTuple):
    """How unlike panoramas are, turned to each other as well as may be."""

    rms: Float[np.ndarray, "pairs"]
    """Root mean square over pixels and colours, grey levels."""
    turn: Float[np.ndarray, "pairs"]
    """By how much (rad, to the left) the body at the first turns to look as at the second."""


def rotational_difference(
    first: UInt8[np.ndarray, "pairs height width 3"], second: UInt8[np.ndarray, "pairs height width 3"]
) -> Difference:
    """Compare panoramas over all turns: the minimum of the rotational image difference function.

    References
    ----------
    Zeil, Hofmann & Chahl (2003), Catchment areas of panoramic snapshots in outdoor scenes.
    """
    width = first.shape[2]
    here, there = (images.astype(np.float32) for images in (first, second))
    power = np.square(here).mean(axis=(1, 2, 3)) + np.square(there).mean(axis=(1, 2, 3))
    product = (fft.rfft(here, axis=2) * fft.rfft(there, axis=2).conj()).sum(axis=(1, 3))
    squares = power[:, None] - 2 * fft.irfft(product, width, axis=1) / first[0].size
    shift = squares.argmin(axis=1)
    rows = np.arange(len(shift))
    before, at, after = (squares[rows, (shift + k) % width] for k in (-1, 0, 1))
    bend = before - 2 * at + after
    # a parabola through three columns finds the least between them
    between = np.where(bend > 0, 0.5 * (before - after) / np.maximum(bend, 1e-12), 0.0)
    columns = (shift + between + width / 2) % width - width / 2
    least = at - 0.25 * (before - after) * between
    return Difference(np.sqrt(np.maximum(least, 0)), -2 * np.pi * columns / width)


class ImageDescent:
    """A policy that goes on while what it sees grows more like the goal's image, else turns and tries anew.

    Steps shrink by a third after each that led uphill. At the end it turns to look as the goal does. It knows
    its camera (a turn shifts columns) and what its commands do, and has no memory but of the last image.
    """

    def __init__(self, goals: UInt8[np.ndarray, "explorers height width 3"], steering: Steering) -> None:
        count = len(goals)
        self._goals, self._steering = goals, steering
        self._before, self._step = np.full(count, np.inf), np.full(count, steering.pace)
        self._to_turn, self._descended = np.zeros(count), np.zeros(count, bool)

    def __call__(self, sensed: Sensed) -> Float[np.ndarray, "explorers 2"]:
        """Decide."""
        seen, steering = rotational_difference(sensed["view"], self._goals), self._steering
        going = (self._to_turn == 0) & ~self._descended
        uphill = going & (seen.rms >= self._before)
        self._step[uphill] *= 2 / 3
        self._to_turn[uphill] = GOLDEN
        self._before[going] = seen.rms[going]
        self._descended |= self._step < LAST * steering.pace
        self._to_turn[self._descended] = 0
        turn = np.clip(self._to_turn, -steering.turn, steering.turn)
        self._to_turn -= turn
        # what is left of a turn is rounding
        self._to_turn[np.abs(self._to_turn) < 1e-9] = 0
        forward = np.where((turn == 0) & ~self._descended, self._step, 0.0)
        turn[self._descended] = seen.turn[self._descended]
        commands = steering.command(forward, turn)
        commands[self._descended & (np.abs(seen.turn) < ALIGNED)] = np.nan
        return commands


def catchment(difference: Float[np.ndarray, "y x"], goal: tuple[int, int]) -> Bool[np.ndarray, "y x"]:
    """Tell from which cells of a grid steepest descent on differences ends at the goal's cell or beside it.

    Parameters
    ----------
    difference
        To the goal's image at each cell; NaN where no body can be.
    goal
        (row, column) of its cell.
    """
    rows, columns = difference.shape
    padded = np.full((rows + 2, columns + 2), np.inf)
    padded[1:-1, 1:-1] = np.where(np.isnan(difference), np.inf, difference)
    around = [(dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    lowest = np.argmin(
        [padded[1 + dy : rows + 1 + dy, 1 + dx : columns + 1 + dx] for dy, dx in around], axis=0
    )
    shifts = np.array(around)[lowest]
    end = np.stack(np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij"), axis=-1) + shifts
    # each round doubles the steps, and a way visits no cell twice
    for _ in range(int(np.ceil(np.log2(rows * columns)))):
        end = end[end[..., 0], end[..., 1]]
    caught: np.ndarray = (np.abs(end - np.array(goal)).max(axis=-1) <= 1) & np.isfinite(difference)
    return caught
