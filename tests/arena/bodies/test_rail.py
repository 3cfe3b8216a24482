import numpy as np
import pytest

from arena.bodies.rail import Rail
from arena.rooms.arena import Arena


def test_the_eye_goes_along_the_rail_and_never_turns() -> None:
    rail = Rail(length=2.0, start=(0.5, -1.0), heading=np.pi / 3)
    poses = rail.camera_poses(np.array([[0.0], [2.0]]))
    wanted = [[0.5, -1.0, np.pi / 3], [0.5 + 1.0, -1.0 + np.sqrt(3), np.pi / 3]]
    np.testing.assert_allclose(poses, wanted)
    (axis,) = rail.axes
    assert (axis.kind, axis.unit, axis.limits) == ("line", "m", (0.0, 2.0))


def test_the_carriage_stops_at_the_ends() -> None:
    at_large = Rail(length=2.0).at_large(Arena.load("furnished"), 1)
    at_large.begin(np.zeros(1, int), np.array([[1.7]]))
    touched = []
    for _ in range(4):
        at_large.step(np.zeros(1, int), np.array([[0.5]]), 0.25, [])
        touched.append(bool(at_large.touched[0]))
    assert touched == [False, False, True, True]
    assert at_large.configurations[0, 0] == pytest.approx(2.0)
