import numpy as np
import pytest

from cogmap.errors import CogmapError
from cogmap.testing import assert_betti


@pytest.fixture
def ring() -> np.ndarray:
    angle = np.random.default_rng(0).uniform(0, 2 * np.pi, 80)
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def test_silent_when_right(ring: np.ndarray) -> None:
    assert_betti(ring, (1, 1, 0))
    assert_betti(ring, (1, 1), metric="euclidean", seed=1, draws=1)
    assert_betti(ring, (1,), max_dimension=1, landmarks=(50, 50))


def test_failure_shows_bars_and_thresholds(ring: np.ndarray) -> None:
    with pytest.raises(AssertionError) as caught:
        assert_betti(ring, (1, 0, 0))
    text = str(caught.value)
    assert "expected Betti numbers [1, 0, 0]" in text
    assert "Betti numbers [1, 1, 0]" in text
    for dimension in range(3):
        assert f"\nH{dimension}: " in text
    assert "largest π: " in text


def test_bad_input_is_not_a_failed_assertion(ring: np.ndarray) -> None:
    with pytest.raises(CogmapError, match="max_dimension is 3"):
        assert_betti(ring, (1, 1, 0, 0))
    with pytest.raises(CogmapError, match="NaN"):
        assert_betti(np.full_like(ring, np.nan), (1, 1, 0))
