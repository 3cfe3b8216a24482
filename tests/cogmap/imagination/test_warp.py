import numpy as np

from cogmap.imagination.warp import averaged, warped


def test_equal_sources_make_themselves() -> None:
    rng = np.random.default_rng(0)
    view = np.repeat(np.repeat(rng.integers(0, 256, (8, 12, 3), np.uint8), 4, axis=0), 8, axis=1)
    views, quarter = np.stack([view, np.roll(view, 5, axis=1), view]), np.array([0.4, 0.6, 0.0], np.float32)
    found = warped(views, np.array([5.0, 0.0, 1.0], np.float32), quarter, quarter)
    assert np.abs(found.view - np.roll(view, 5, axis=1)).mean() < 2


def test_the_average_and_its_spread() -> None:
    painted = np.stack([np.full((2, 3, 3), grey, np.float32) for grey in (10, 30)])
    found = averaged(painted, np.array([0.5, 0.5], np.float32))
    np.testing.assert_allclose(found.view, 20)
    np.testing.assert_allclose(found.spread, 10)
