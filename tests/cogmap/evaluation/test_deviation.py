import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cogmap.errors import CogmapError
from cogmap.evaluation.deviation import path_deviation, path_length


def test_the_straight_path_does_not_deviate_even_across_the_cut() -> None:
    share = np.linspace(0, 1, 7)[:, None]
    path = np.array([0.0, 1, 3]) + share * np.array([2, 1, 1.0])
    path[:, 2] = np.angle(np.exp(1j * path[:, 2]))
    np.testing.assert_allclose(path_deviation(path), 0, atol=1e-12)


def test_a_tent_deviates_by_half_its_height() -> None:
    found = path_deviation(np.array([[0.0, 0, 0], [1, 1, 0], [2, 0, 0]]))
    assert found.mean == pytest.approx(0.5, abs=0.01)
    assert found.maximum == pytest.approx(1, abs=0.01)
    assert found.variance == pytest.approx(1 / 12, abs=0.002)


def test_three_samples_see_the_ends_and_the_middle() -> None:
    found = path_deviation(np.array([[0.0, 0, 0], [1, 1, 0], [2, 0, 0]]), samples=3)
    assert found.mean == pytest.approx(1 / 3)


def test_a_turn_counts_half_a_metre_a_radian() -> None:
    found = path_deviation(np.array([[0.0, 0, 0], [1, 0, 1.0], [2, 0, 0]]))
    assert found.maximum == pytest.approx(0.5, abs=0.01)


def test_beyond_its_ends_a_path_deviates_from_the_ends() -> None:
    away = path_deviation(np.array([[0.0, 0, 0], [-2, 0, 0], [1, 0, 0]]))
    assert away.maximum == pytest.approx(2, abs=0.02)
    assert away.mean == pytest.approx(4 / 5, abs=0.01)
    assert path_deviation(np.array([[0.0, 0, 0], [3, 0, 0], [1, 0, 0]])).maximum == pytest.approx(2, abs=0.02)


def test_a_full_turn_comes_back_to_nothing() -> None:
    path = np.column_stack([np.zeros((9, 2)), np.linspace(0, 2 * np.pi, 9)])
    assert path_deviation(path).maximum == pytest.approx(0.5 * np.pi, abs=0.01)


@given(st.floats(-3, 3), st.floats(-5, 5), st.floats(0.1, 3))
def test_turning_and_moving_the_room_changes_nothing(angle: float, shift: float, side: float) -> None:
    path = np.array([[0.0, 0, 0.1], [side, 0.4, 0.7], [1, side, -0.6], [2, 1, 0.2]])
    turned = path.copy()
    cosine, sine = np.cos(angle), np.sin(angle)
    turned[:, :2] = path[:, :2] @ np.array([[cosine, sine], [-sine, cosine]]) + shift
    turned[:, 2] += angle
    np.testing.assert_allclose(path_deviation(turned), path_deviation(path), atol=1e-9)
    assert path_length(turned) == pytest.approx(path_length(path))


def test_standing_still_is_no_deviation_and_nonsense_is_refused() -> None:
    assert path_deviation(np.zeros((2, 3))).maximum == 0
    with pytest.raises(CogmapError, match="path has shape"):
        path_deviation(np.zeros((0, 3)))
    with pytest.raises(CogmapError, match="not finite"):
        path_deviation(np.full((2, 3), np.inf))
