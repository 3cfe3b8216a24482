import numpy as np

from arena import Arena
from arena.eye.base import Eye
from cogmap.control.percept import Percept
from cogmap.evaluation.peers.true_pose import PoseEye, TruePercept

POSES = np.random.default_rng(0).uniform(-3, 3, (20, 3))


def test_poses_are_read_back_to_the_bit() -> None:
    eye, percept = PoseEye(), TruePercept()
    assert isinstance(eye, Eye)
    assert isinstance(percept, Percept)
    images = eye.render(Arena.load("furnished"), POSES, rng=np.random.default_rng(0))
    assert images.shape == (20, eye.height, eye.width, 3)
    assert images.dtype == np.uint8
    seen = percept.perceive(images)
    np.testing.assert_array_equal(np.column_stack([seen.position, seen.phase]), POSES)
    np.testing.assert_array_equal(seen.novelty, 0)
    turned = percept.turns(images[:-1], images[1:])
    np.testing.assert_allclose(np.exp(1j * turned), np.exp(1j * np.diff(POSES[:, 2])))
