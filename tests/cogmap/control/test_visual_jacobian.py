import numpy as np
import pytest

from cogmap import CogmapError
from cogmap.control.visual_jacobian import VisualJacobian, implied_work

LINEAR = np.array([[3.0, 0.0, 1.0], [0.0, -2.0, 0.5]])
"""What each of two motors does to each of three features: one of them turns the wrong way round."""


def babbled(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    work = rng.uniform(-0.1, 0.1, size=(300, 2))
    return np.vstack([np.zeros(2), np.cumsum(work, axis=0)]), work


def test_a_linear_world_is_learnt_exactly() -> None:
    places, work = babbled(np.random.default_rng(0))
    learnt = VisualJacobian(places @ LINEAR, work)
    found = learnt.at(places[:5] @ LINEAR)
    np.testing.assert_allclose(found, np.broadcast_to(LINEAR, found.shape), rtol=5e-3, atol=5e-3)
    asked = np.array([[0.3, -0.2]] * 5)
    np.testing.assert_allclose(implied_work(found, asked @ LINEAR), asked, rtol=5e-3)
    assert not learnt.held_.any()
    assert 0.03 < learnt.pace_ < 0.12


def test_what_held_the_body_is_found_and_spoils_nothing() -> None:
    places, work = babbled(np.random.default_rng(1))
    held = np.arange(10, 300, 20)
    work = np.insert(work, held, [0.08, 0.08], axis=0)
    places = np.insert(places, held + 1, places[held], axis=0)
    learnt = VisualJacobian(places @ LINEAR, work)
    np.testing.assert_array_equal(np.flatnonzero(learnt.held_), held + np.arange(len(held)))
    np.testing.assert_allclose(learnt.held_codes, places[:-1][learnt.held_] @ LINEAR)
    np.testing.assert_allclose(learnt.at(places[:1] @ LINEAR)[0], LINEAR, rtol=5e-3, atol=5e-3)


def test_too_little_babbling_is_told() -> None:
    with pytest.raises(CogmapError, match="babble at least 40"):
        VisualJacobian(np.zeros((11, 3)), np.zeros((10, 2)))
    with pytest.raises(CogmapError, match="work"):
        VisualJacobian(np.zeros((100, 3)), np.zeros((100, 2)))


def test_a_jacobian_that_turns_is_that_of_the_view_and_not_a_mean() -> None:
    """What the second motor does turns with its own joint, and shows less than what the first does."""

    def seen(joints: np.ndarray) -> np.ndarray:
        first, second = joints.T
        return np.column_stack([first, 0.1 * np.sin(6 * second), 0.1 * np.cos(6 * second)])

    rng = np.random.default_rng(2)
    begun = rng.uniform(-0.3, 0.3, size=(600, 2))
    moved = begun + np.array([0.04, 0.05]) * rng.choice([-1, 1], size=(600, 2))
    places = np.stack([begun, moved], axis=1).reshape(-1, 2)
    learnt = VisualJacobian(seen(places), np.diff(places, axis=0))
    queries = places[rng.choice(np.flatnonzero(np.abs(places).max(axis=1) < 0.2), 40)]
    angle = 6 * queries[:, 1]
    exact = 0.6 * np.column_stack([np.zeros(40), np.cos(angle), -np.sin(angle)])
    plain, bent = (
        np.median(np.linalg.norm(found[:, 1] - exact, axis=1))
        for found in (learnt.at(seen(queries)), learnt.bent(seen(queries), seen(places)))
    )
    assert bent < 0.5 * plain
