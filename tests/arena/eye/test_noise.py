import numpy as np
import pytest

from arena.errors import ArenaError
from arena.eye.noise import add_noise


def test_noise_is_of_its_size_and_each_has_its_own() -> None:
    views = np.full((2, 40, 50, 3), 128, np.uint8)
    add_noise(views, 0.05, [np.random.default_rng(k) for k in (0, 1)])
    assert views.std() == pytest.approx(255 * 0.05, rel=0.03)
    assert not np.array_equal(*views)
    alone = np.full((1, 40, 50, 3), 128, np.uint8)
    add_noise(alone, 0.05, np.random.default_rng(1))
    np.testing.assert_array_equal(alone[0], views[1])


def test_none_needs_no_generator() -> None:
    views = np.zeros((1, 2, 2, 3), np.uint8)
    add_noise(views, 0.0, None)
    assert not views.any()
    with pytest.raises(ArenaError, match="give `rng`"):
        add_noise(views, 0.1, None)
