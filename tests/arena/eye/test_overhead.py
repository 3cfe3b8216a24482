import numpy as np
import pytest

from arena.bodies.arm import Arm
from arena.bodies.disc import Disc
from arena.bodies.turntable import Turntable
from arena.errors import ArenaError
from arena.eye.overhead import Overhead
from arena.rooms.arena import Arena

ROOM = Arena.load("obstacles")
RED, BLUE, WHITE = (214, 69, 65), (40, 70, 180), (226, 226, 222)
RNG = np.random.default_rng


def pixel(eye: Overhead, view: np.ndarray, x: float, y: float) -> tuple[int, ...]:
    scale = eye.width / eye.span
    column, row = (x - eye.center[0]) * scale + eye.width / 2, (eye.center[1] - y) * scale + eye.height / 2
    return tuple(view[int(row), int(column)].tolist())


@pytest.mark.parametrize("eye", [Overhead(400, 400), Overhead(500, 300, center=(0.3, -0.2), span=5.0)])
def test_everything_is_where_it_is(eye: Overhead) -> None:
    arm = Arm()
    (view,) = eye.look(ROOM, arm, np.array([[-0.5, -0.5]]))
    assert view.shape == (eye.height, eye.width, 3)
    angles = np.array([-0.5, -1.0])
    elbow = np.array([np.cos(-0.5), np.sin(-0.5)])
    hand = elbow + 0.8 * np.array([np.cos(-1.0), np.sin(-1.0)])
    assert pixel(eye, view, *(0.5 * elbow)) == BLUE
    assert pixel(eye, view, *(0.5 * (elbow + hand))) == WHITE
    assert pixel(eye, view, *(hand + 0.04 * np.array([np.cos(angles[1]), np.sin(angles[1])]))) == RED
    assert pixel(eye, view, -1.0, -1.0) == ROOM.floor
    (empty,) = eye.look(ROOM, Disc(radius=0.01), np.array([[-1.5, -1.0, 0.0]]))
    wall = pixel(eye, empty, -0.8, 0.3)
    assert np.abs(np.subtract(wall, ROOM.floor)).max() > 20


def test_what_is_seen_of_a_disc_is_its_size_and_heading() -> None:
    eye = Overhead(200, 200)
    views = eye.look(ROOM, Disc(radius=0.3), np.array([[-1.2, -0.9, 0.0], [-1.2, -0.9, np.pi]])).astype(int)
    (nothing,) = eye.look(ROOM, Disc(radius=0.001), np.array([[1.7, 1.7, 0.0]])).astype(int)
    changed = (np.abs(views[0] - nothing).max(axis=2) > 44).sum() * (4 / 200) ** 2
    assert changed == pytest.approx(np.pi * 0.3**2, rel=0.05)
    np.testing.assert_array_equal(views[0][128:165, 20:60], views[1][128:165, 59:19:-1])
    assert pixel(eye, views[0], -1.05, -0.9) == RED


def test_images_change_in_proportion_to_how_far_the_body_moves() -> None:
    angles = np.linspace(1.0, 1.02, 9)[:, None]
    views = Overhead(64, 64).look(ROOM, Turntable(), angles).astype(float)
    steps = np.abs(np.diff(views, axis=0)).mean(axis=(1, 2, 3))
    assert steps.max() < 1.6 * steps.min()


def test_views_are_the_same_however_they_are_batched_and_have_their_noise() -> None:
    arm, eye = Arm(), Overhead(32, 32, noise=0.05)
    joints = arm.sample_free(ROOM, 3, RNG(0))
    together = eye.look(ROOM, arm, joints, rng=[RNG(k) for k in range(3)])
    for k in range(3):
        np.testing.assert_array_equal(eye.look(ROOM, arm, joints[k : k + 1], rng=RNG(k))[0], together[k])
    with pytest.raises(ArenaError, match="give `rng`"):
        eye.look(ROOM, arm, joints)


def test_a_material_that_is_not_there() -> None:
    with pytest.raises(ArenaError, match="no material 'glass'"):
        Overhead(links=("blue", "glass"))
    assert Overhead(**Overhead(80, 60).model_dump(mode="json")) == Overhead(80, 60)
