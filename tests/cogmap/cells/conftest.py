from collections.abc import Callable

import numpy as np
import pytest

Samples = tuple[np.ndarray, np.ndarray]


@pytest.fixture
def wander() -> Callable[..., Samples]:
    """Random positions in a 3.6×2.6 m room, with random headings."""

    def draw(views: int = 5000, seed: int = 0) -> Samples:
        rng = np.random.default_rng(seed)
        return rng.uniform([-1.8, -1.3], [1.8, 1.3], (views, 2)), rng.uniform(-np.pi, np.pi, views)

    return draw


@pytest.fixture
def hall() -> Samples:
    """2,500 views in a 9×6 m room, on straight runs of five: each place was seen in few directions."""
    rng = np.random.default_rng(0)
    starts, headings = rng.uniform([-4.5, -3], [4.5, 3], (500, 1, 2)), rng.uniform(-np.pi, np.pi, 500)
    ahead = 0.12 * np.stack([np.cos(headings), np.sin(headings)], axis=1)[:, None]
    positions = (starts + np.arange(5)[:, None] * ahead).reshape(-1, 2)
    return np.clip(positions, [-4.5, -3], [4.5, 3]), np.repeat(headings, 5)


@pytest.fixture
def bump() -> Callable[..., np.ndarray]:
    """Gaussian tuning to place: 10 Hz at the centre."""

    def rate(
        positions: np.ndarray, centre: tuple[float, float] = (0.3, -0.2), width: float = 0.3
    ) -> np.ndarray:
        return 10 * np.exp(-np.sum((positions - centre) ** 2, axis=1) / (2 * width**2))

    return rate


@pytest.fixture
def von_mises() -> Callable[..., np.ndarray]:
    """Von Mises tuning to direction: 10 Hz at the preferred one."""

    def rate(headings: np.ndarray, preferred: float | np.ndarray = 0.5, kappa: float = 4.0) -> np.ndarray:
        return 10 * np.exp(kappa * (np.cos(headings - preferred) - 1))

    return rate


@pytest.fixture
def hexagonal() -> Callable[..., np.ndarray]:
    """A grid cell's rates in (0, 1]: three plane waves whose crests cross at 60°."""

    def rate(
        positions: np.ndarray, spacing: float, turn: float = 0.0, phase: tuple[float, float] = (0.0, 0.0)
    ) -> np.ndarray:
        angles = turn + np.deg2rad([30, 90, 150])
        along = (positions - phase) @ np.stack([np.cos(angles), np.sin(angles)])
        return (np.cos(4 * np.pi / (np.sqrt(3) * spacing) * along).sum(axis=1) + 1.5) / 4.5

    return rate
