from collections.abc import Iterator

import numpy as np
import pytest

from cogmap.coordinates import view_code


@pytest.fixture(scope="package", autouse=True)
def _short_lesson() -> Iterator[None]:
    """Learn components from fewer batches."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(view_code, "STEPS", 40)
        yield


def spots(places: np.ndarray, colours: tuple[int, int, int] = (200, 90, 40)) -> np.ndarray:
    """Pictures of a soft spot at places (x, y) in [−1, 1], on a still background."""
    y, x = np.mgrid[-1.5:1.5:24j, -1.5:1.5:24j]
    bright = np.exp(-((x - places[:, :1, None]) ** 2 + (y - places[:, 1:, None]) ** 2) / 0.5)
    background = np.random.default_rng(0).uniform(10, 50, size=(24, 24, 3))
    return (background + bright[..., None] * np.array(colours)).astype(np.uint8)


@pytest.fixture(scope="package")
def angles() -> np.ndarray:
    return np.random.default_rng(1).uniform(-np.pi, np.pi, 1000)


@pytest.fixture(scope="package")
def ring(angles: np.ndarray) -> np.ndarray:
    """What a fixed eye sees of a turntable."""
    return spots(np.column_stack([np.cos(angles), np.sin(angles)]))


@pytest.fixture(scope="package")
def sheet() -> tuple[np.ndarray, np.ndarray]:
    """What a fixed eye sees of a carriage on rails that cross, and where the carriage is."""
    places = np.random.default_rng(2).uniform(-1, 1, size=(1500, 2))
    return spots(places), places
