import numpy as np
import pytest

from cogmap.imagination.stroll import stroll

ROUTE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]])


def test_a_stroll_turns_before_it_goes() -> None:
    poses = stroll(ROUTE, step=0.25, turn=0.2, start=0.5, end=3.0)
    np.testing.assert_allclose(poses[0], [0, 0, 0.5])
    np.testing.assert_allclose(poses[-1], [1, 2, 3.0])
    steps, turns = np.diff(poses[:, :2], axis=0), np.angle(np.exp(1j * np.diff(poses[:, 2])))
    lengths = np.linalg.norm(steps, axis=1)
    assert lengths.max() <= 0.25 + 1e-12
    assert np.abs(turns).max() <= 0.2 + 1e-12
    assert not (lengths * np.abs(turns) > 1e-12).any()
    assert lengths.sum() == pytest.approx(3)
    going = lengths > 0
    np.testing.assert_allclose(np.arctan2(*steps[going].T[::-1]), poses[1:, 2][going], atol=1e-9)


def test_it_turns_the_short_way_and_may_stay_where_it_is() -> None:
    poses = stroll(np.zeros((1, 2)), step=0.1, turn=0.1, start=3.1, end=-3.1)
    assert len(poses) == 2
    poses = stroll(ROUTE, step=1.0, turn=10.0)
    np.testing.assert_allclose(poses[:, 2], [0, 0, np.pi / 2, np.pi / 2, np.pi / 2])
