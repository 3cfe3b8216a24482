"""Ways over a torus whose code is two circles, known in closed form."""

import numpy as np
import pytest

from arena.angles import wrap_angle
from cogmap.control.posture_ways import PostureWays
from cogmap.control.visual_jacobian import VisualJacobian

GOALS = np.array([[3.0, -3.0], [0.0, 1.5]])


def code(joints: np.ndarray) -> np.ndarray:
    return np.hstack([np.cos(joints), np.sin(joints)])


@pytest.fixture(scope="module")
def babbled() -> tuple[np.ndarray, np.ndarray]:
    work = np.random.default_rng(0).uniform(-1.0, 1.0, size=(3000, 2))
    return np.vstack([np.zeros(2), np.cumsum(work, axis=0)]), work


@pytest.fixture(scope="module")
def ways(babbled: tuple[np.ndarray, np.ndarray]) -> PostureWays:
    joints, work = babbled
    steps = np.repeat(work / 10, 10, axis=0)
    joints = np.vstack([np.zeros(2), np.cumsum(steps, axis=0)])[::10]
    fine = np.vstack([np.zeros(2), np.cumsum(steps, axis=0)])[:8000]
    return PostureWays(code(joints[:1500]), VisualJacobian(code(fine), steps[:7999]))


def test_work_left_is_the_way_round_the_torus(
    ways: PostureWays, babbled: tuple[np.ndarray, np.ndarray]
) -> None:
    kept = babbled[0][:1500]
    left = ways.work_left(ways.look(code(GOALS)))
    direct = np.linalg.norm(wrap_angle(kept - GOALS[:, None]), axis=2)
    far = direct > 0.5
    assert np.isfinite(left).all()
    assert 0.95 < np.median(left[far] / direct[far]) < 1.2


def test_work_leads_to_what_is_remembered(ways: PostureWays, babbled: tuple[np.ndarray, np.ndarray]) -> None:
    sight = ways.look(code(GOALS))
    way = wrap_angle(babbled[0][sight.indices] - GOALS[:, None])
    np.testing.assert_allclose(sight.work, way, atol=0.12)
    np.testing.assert_allclose(sight.effort, np.linalg.norm(sight.work, axis=2))


def test_look_alikes_are_no_way() -> None:
    work = np.random.default_rng(1).uniform(-0.1, 0.1, size=(2000, 2))
    joints = np.clip(np.cumsum(np.vstack([np.zeros(2), work]), axis=0), -3, 3)
    codes = np.column_stack([joints, np.zeros(len(joints))])
    learnt = VisualJacobian(codes, work)
    # a sheet above the first one: no work leads there
    both = np.vstack([codes[::10], codes[::10] + np.array([0.0, 0.0, 0.05])])
    ends = np.array(PostureWays(both, learnt).graph.nonzero())
    assert len(ends.T)
    steep = np.abs(both[ends[0], 2] - both[ends[1], 2])
    flat = np.linalg.norm((both[ends[0]] - both[ends[1]])[:, :2], axis=1)
    assert (steep <= 0.8 * np.hypot(steep, flat) + 1e-3).all()


def test_work_is_dear_where_something_held_the_body(ways: PostureWays) -> None:
    np.testing.assert_array_equal(ways.costs, 1.0)
    work = np.random.default_rng(2).uniform(-0.1, 0.1, size=(1500, 2))
    joints = np.zeros((1501, 2))
    for step, moved in enumerate(work):
        joints[step + 1] = np.clip(joints[step] + moved, -0.8, 0.8)
    fenced = PostureWays(joints[::5], VisualJacobian(joints, work))
    edge = np.abs(joints[::5]).max(axis=1)
    assert fenced.costs[edge > 0.78].mean() > 3 * fenced.costs[edge < 0.5].mean()
