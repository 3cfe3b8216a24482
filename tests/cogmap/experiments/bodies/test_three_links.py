import numpy as np

from arena.angles import wrap_angle
from cogmap.experiments.bodies.three_links import look_alikes


def test_look_alikes_differ_in_posture_alone() -> None:
    joints = np.random.default_rng(0).uniform(-0.2, 0.2, size=(40, 3))
    joints[20] = joints[3] + [2.0, -2.0, 1.0]
    codes = joints.copy()
    codes[20] = codes[3] + 1e-4
    pairs = look_alikes(codes, joints).tolist()
    assert [3, 20] in pairs
    assert all(20 in pair for pair in pairs)
    # a joint that turns all round passes π
    turned = np.delete(joints, 20, axis=0) + np.array([3.1, 0.0, 0.0])
    assert not len(look_alikes(turned, wrap_angle(turned)))
