"""A rat that never was, whose cells are known."""

from typing import NamedTuple

import numpy as np


class Rat(NamedTuple):
    """Ten minutes in a box of 1 m at 20 Hz; Poisson cells: a grid of 16 place cells, 6 of heading."""

    times: np.ndarray
    positions: np.ndarray
    headings: np.ndarray
    trains: list[np.ndarray]
    counts: np.ndarray

    @property
    def track(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self.times, self.positions, self.headings


def walk_and_fire() -> Rat:
    rng, dt = np.random.default_rng(0), 0.05
    times = 3 + dt * np.arange(12_000)
    headings = np.cumsum(rng.normal(0, 0.2, len(times)))
    steps = 0.25 * dt * np.stack([np.cos(headings), np.sin(headings)], axis=1)
    positions = np.abs((np.cumsum(steps, axis=0) + 0.5) % 2 - 1)
    headings = (headings + np.pi) % (2 * np.pi) - np.pi
    centres = np.stack(np.meshgrid([0.2, 0.4, 0.6, 0.8], [0.2, 0.4, 0.6, 0.8]), axis=-1).reshape(-1, 2)
    place = 15 * np.exp(-((positions[:, None] - centres) ** 2).sum(axis=2) / (2 * 0.1**2))
    heading = 20 * np.exp(4 * (np.cos(headings[:, None] - np.arange(6)) - 1))
    counts = rng.poisson(np.hstack([place, heading]) * dt)
    # Away from the ends of a sample, so that no rounding of times carries a spike over.
    trains = [
        np.sort(np.repeat(times, count) + dt * rng.uniform(0.01, 0.99, count.sum())) for count in counts.T
    ]
    return Rat(times, positions, headings, trains, counts)
