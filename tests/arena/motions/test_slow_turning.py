import numpy as np

from arena import Arena, Disc, Motion
from arena.motions.slow_turning import SlowTurning


def test_heading_is_slow_and_place_is_not() -> None:
    room = Arena.load("furnished")
    walk = SlowTurning().walk(room, Disc(), 1500, np.random.default_rng(0))
    turn = np.angle(np.exp(1j * np.diff(walk.poses[:, 2])))
    np.testing.assert_allclose(turn.std(), 0.05, rtol=0.1)
    assert (np.abs(walk.poses[:, 2]) <= np.pi).all()
    assert np.median(np.linalg.norm(np.diff(walk.poses[:, :2], axis=0), axis=1)) > 0.3
    assert room.is_free(walk.poses[:, :2], 0.17).all()


def test_it_is_a_motion_of_its_own() -> None:
    assert isinstance(SlowTurning(), Motion)
    assert SlowTurning(turn=0.1).model_dump() == {"turn": 0.1, "view_every_m": 1.0}
