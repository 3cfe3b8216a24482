import numpy as np

from arena.bodies.turntable import Turntable


def test_the_eye_turns_on_the_spot_as_the_pointer_does() -> None:
    table, angles = Turntable(base=(0.3, -0.2), length=0.5), np.array([[0.0], [1.0], [-3.0]])
    np.testing.assert_allclose(table.camera_poses(angles), [[0.3, -0.2, a] for a in (0.0, 1.0, -3.0)])
    tips = table.segments(angles)[:, 0, 1] - [0.3, -0.2]
    np.testing.assert_allclose(tips, 0.5 * np.column_stack([np.cos(angles), np.sin(angles)]))
    assert [axis.kind for axis in table.axes] == ["circle"]
