import numpy as np

from arena import Neck, Recording
from cogmap.experiments.bodies.neck import visible_axes

JOINTS = np.array([[1.0, 2.0, 3.0, 1.0], [0.0, 0.5, -1.0, 0.25]])


def test_gaze_is_the_sum_of_two_joints() -> None:
    recording = Recording(views=np.zeros((2, 4, 4, 3), np.uint8), times=np.arange(2.0), joints=JOINTS)
    axes, joints = visible_axes(Neck(), recording)
    assert [axis.name for axis in axes] == ["x", "y", "gaze"]
    np.testing.assert_allclose(joints, [[1, 2, 4 - 2 * np.pi], [0, 0.5, -0.75]])
    axes, joints = visible_axes(Neck(deck="seen"), recording)
    assert [axis.name for axis in axes] == ["x", "y", "heading", "pan"]
    np.testing.assert_array_equal(joints, JOINTS)
