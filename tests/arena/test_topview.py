import numpy as np
import pytest

from arena.bodies.arm import Arm
from arena.rooms.arena import Arena
from arena.topview import TopView

BODY = (214, 69, 65)


def pixel(view: TopView, picture: np.ndarray, x: float, y: float) -> tuple[int, ...]:
    (column, row), *_ = view._pixels(np.array([(x, y)])) / 16
    return tuple(int(value) for value in picture[round(row), round(column)])


@pytest.mark.parametrize("height", [60, 240, 500])
def test_shape_is_that_of_the_room(height: int) -> None:
    picture = TopView(Arena.load("open_field"), height).draw((0.0, 0.0, 0.0), 0.18, np.empty((0, 2)))
    assert picture.shape == (height, round(height * 6.2 / 5.2), 3)
    assert picture.dtype == np.uint8


@pytest.mark.parametrize("pose", [(1.0, 0.5, 0.0), (-1.5, -0.9, np.pi / 2), (0.2, 1.1, -2.0)])
def test_body_is_where_it_is_and_of_its_size(pose: tuple[float, float, float]) -> None:
    view = TopView(Arena.load("open_field"), 1200)
    picture = view.draw(pose, 0.18, np.empty((0, 2)))
    x, y, heading = pose
    back = pixel(view, picture, x - 0.1 * np.cos(heading), y - 0.1 * np.sin(heading))
    ahead = pixel(view, picture, x + 0.1 * np.cos(heading), y + 0.1 * np.sin(heading))
    assert back == BODY
    assert ahead == (255, 255, 255)
    changed = (picture != view._room).any(axis=2)
    assert changed.sum() / view._scale**2 == pytest.approx(np.pi * 0.18**2, rel=0.1)
    rows, columns = np.nonzero(changed)
    wanted = view._pixels(np.array([(x, y)]))[0] / 16
    np.testing.assert_allclose((columns.mean(), rows.mean()), wanted, atol=2)


def test_platform_is_light_and_solids_are_not() -> None:
    view = TopView(Arena.load("pillar"))
    room = view._room
    assert pixel(view, room, 1.0, 0.5) == (226, 222, 214)
    assert max(pixel(view, room, 0.0, 0.0)) < 120
    assert max(pixel(view, room, 2.3, 0.0)) < 120
    source = Arena.load("pillar").sources[0].position
    assert pixel(view, room, source[0] + 0.08, source[1]) == (44, 140, 82)


def test_trail_is_drawn_and_forgotten() -> None:
    view = TopView(Arena.load("open_field"))
    trail = np.array([(-1.0, -1.0), (-1.0, 1.0), (0.5, 1.0)])
    picture = view.draw((0.5, 1.0, 0.0), 0.1, trail)
    assert pixel(view, picture, -1.0, 0.3)[2] > pixel(view, picture, -1.0, 0.3)[0]
    np.testing.assert_array_equal(pixel(view, view._room, -1.0, 0.3), (226, 222, 214))


def test_links_are_drawn_as_thick_as_they_are() -> None:
    view, arm, joints = TopView(Arena.load("open_field"), 1200), Arm(), np.array([[1.0, -2.0]])
    (links,), (pose,) = arm.segments(joints), arm.camera_poses(joints)
    picture = view.draw(tuple(pose.tolist()), arm.radius, np.empty((0, 2)), links)
    for start, end in links:
        assert pixel(view, picture, *(0.5 * (start + end))) == BODY
    area = (picture != view._room).any(axis=2).sum() / view._scale**2
    assert area == pytest.approx(1.8 * 0.16 + np.pi * 0.08**2, rel=0.1)
