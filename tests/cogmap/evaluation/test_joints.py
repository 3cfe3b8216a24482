import numpy as np
import pytest

from arena.angles import wrap_angle
from cogmap.errors import CogmapError
from cogmap.evaluation.joints import (
    interpolated_joints,
    joint_errors,
    joint_medians,
    read_joints,
    windings,
)


def torus(views: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, size=(views, 2))


@pytest.mark.parametrize("matrix", [[[1, 0], [0, 1]], [[1, 1], [0, -1]], [[2, 1], [1, 1]], [[2, 0], [0, 1]]])
def test_windings_of_bent_angles(matrix: list[list[int]]) -> None:
    joints = torus(2500)
    bent = joints + 0.5 * np.sin(joints[:, ::-1] + 1)
    found = windings(wrap_angle(bent @ np.array(matrix).T + 2.0), joints, [True, True])
    np.testing.assert_array_equal(found.matrix, matrix)
    assert found.determinant == round(np.linalg.det(matrix))
    assert found.agreement > 0.95


def test_windings_around_a_joint_with_limits() -> None:
    joints = torus(2500, 1) * [1.0, 0.3]
    found = windings(wrap_angle(joints @ [[-1.0], [0.7]]), joints, [True, False])
    assert found.matrix[0, 0] == -1
    assert found.matrix[0, 1] == pytest.approx(0.7, abs=0.05)
    assert found.determinant == -1
    assert windings(joints[:, :1], joints, [False, False]).determinant is None


def test_joints_are_read_on_the_other_half() -> None:
    joints = torus(700, 2) * [1.0, 0.4]
    phase = wrap_angle(joints[:, :1] + 0.6 * np.sin(joints[:, :1]) + 1)
    coordinates = np.hstack([phase, (joints[:, 1:] + 0.1 * joints[:, 1:] ** 3) / joints[:, 1].std()])
    read = read_joints(coordinates, 1, joints, [True, False])
    assert len(read.views) == len(read.errors) == 350
    assert len(np.unique(read.views)) == 350
    assert (np.median(abs(read.errors), axis=0) < 0.01).all()
    assert (read.correlations > 0.999).all()
    nothing = read_joints(np.random.default_rng(3).normal(size=(700, 2)), 0, joints, [True, False])
    assert np.median(abs(nothing.errors[:, 0])) > 1


def test_angles_are_interpolated_the_short_way() -> None:
    joints = np.array([[3.1, 0.0], [-3.1, 1.0], [3.0, 2.0]])
    weights = np.array([[0.5, 0.5, 0.0], [1.0, 1.0, -1.0]])
    read = interpolated_joints(np.array([[0, 1, 2], [2, 1, 0]]), weights, joints, [True, False])
    np.testing.assert_allclose(abs(read[0, 0]), np.pi, atol=1e-9)
    assert read[0, 1] == 0.5
    np.testing.assert_allclose(read[1], [wrap_angle(3.0 + (2 * np.pi - 6.1) - 0.1), 3.0])


def test_errors_and_medians_in_the_units_of_people() -> None:
    errors = joint_errors(np.array([[3.1, 1.0]] * 3), np.array([[-3.1, 0.9]] * 3), [True, False])
    degrees, metres = joint_medians(errors, ["rad", "m"])
    assert degrees == pytest.approx(np.rad2deg(2 * np.pi - 6.2))
    assert metres == pytest.approx(0.1)


def test_what_does_not_fit_is_told() -> None:
    with pytest.raises(CogmapError, match="2 joints but 1 circles"):
        windings(np.zeros((9, 1)), np.zeros((9, 2)), [True])
