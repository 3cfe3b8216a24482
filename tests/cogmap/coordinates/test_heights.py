import numpy as np
import pytest

from cogmap.coordinates.heights import heights


def test_height_of_a_cylinder() -> None:
    rng = np.random.default_rng(0)
    phase, height = rng.uniform(-np.pi, np.pi, 900), rng.uniform(-1.5, 1.5, 900)
    found = heights(np.column_stack([np.cos(phase), np.sin(phase), height]), phase[:, None], 1)
    assert found.shape == (900, 1)
    assert abs(np.corrcoef(found[:, 0], height)[0, 1]) > 0.995
    assert found.std() == pytest.approx(1)


def test_no_height_of_a_ring() -> None:
    assert heights(np.zeros((5, 2)), np.zeros((5, 1)), 0).shape == (5, 0)


def test_stray_pieces_have_none() -> None:
    plane = np.random.default_rng(1).uniform(size=(400, 2))
    found = heights(np.vstack([plane, plane[:30] + 100]), np.empty((430, 0)), 2, one_sided=5)
    assert np.isnan(found[400:]).all()
    both = np.linalg.lstsq(np.column_stack([found[:400], np.ones(400)]), plane, rcond=None)[1]
    assert (both < 0.01 * 400 * plane.var(axis=0)).all()
