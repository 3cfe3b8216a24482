import numpy as np
import pytest

from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.motions.base import Walk
from arena.motions.track import Track
from arena.rooms.arena import Arena


def run(motion: Track, views: int = 600, arena: str = "open_field", body: Disc | None = None) -> Walk:
    return motion.walk(Arena.load(arena), body or Disc(), views, np.random.default_rng(0))


def test_it_stays_on_the_long_axis_and_reaches_both_ends() -> None:
    x, y, _ = run(Track()).poses.T
    np.testing.assert_allclose(y, 0.0, atol=1e-9)
    assert (x.min(), x.max()) == pytest.approx((-1.8, 1.8), abs=0.05)
    assert np.abs(x).max() <= 1.8 + 1e-9


def test_it_turns_at_the_ends_only_and_to_either_side() -> None:
    x, _, heading = run(Track(), 2000).poses.T
    along = np.minimum(np.abs(heading), np.pi - np.abs(heading)) < 1e-6
    assert (np.abs(x[~along]) > 1.8 - 0.12 - 1e-6).all()
    turning = heading[~along & (x > 0)]
    assert 0.2 < (turning > 0).mean() < 0.8
    middle = np.abs(x) < 1
    assert 0.4 < (np.abs(heading[middle]) < 1).mean() < 0.6


def test_it_goes_to_and_fro_at_the_mean_speed() -> None:
    times, poses, *_ = run(Track(speed=0.3, speed_spread=0.0), 400)
    x, straight = poses[:, 0], np.abs(poses[:, 0]) < 1.5
    pairs = straight[1:] & straight[:-1]
    speed = np.abs(np.diff(x) / np.diff(times))[pairs]
    np.testing.assert_allclose(speed, 0.3, rtol=1e-6)
    assert (np.diff(np.sign(np.diff(x)[np.diff(x) != 0])) != 0).sum() > 5


def test_no_two_runs_see_quite_the_same() -> None:
    poses = run(Track(), 2000).poses
    assert len(np.unique(poses.round(6), axis=0)) == len(poses)


def test_the_ends_may_be_told() -> None:
    x, y, _ = run(Track(ends=((-1.0, -1.0), (1.0, 0.0)))).poses.T
    np.testing.assert_allclose(y, 0.5 * (x - 1), atol=1e-6)
    assert (x.min(), x.max()) == pytest.approx((-1.0, 1.0), abs=0.05)


def test_a_slow_body_keeps_near_the_line() -> None:
    x, y, _ = run(Track(), body=Disc(max_acceleration=1.0, max_turn_acceleration=2.0)).poses.T
    assert np.abs(y).max() < 0.03
    assert np.ptp(x) > 3.5


def test_the_long_way_of_an_l_is_one_of_its_arms() -> None:
    ell = [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)]
    wall = [{"start": (-9.0, -9.0), "end": (9.0, -9.0), "material": "brick"}]
    arena = Arena.create(name="ell", platform=[ell], walls=wall)
    x, y, _ = Track().walk(arena, Disc(), 300, np.random.default_rng(0)).poses.T
    assert (x.min(), x.max()) == pytest.approx((0.2, 3.8), abs=0.05)
    assert np.ptp(y) < 1e-6
    assert 0.18 < y.min() < 0.82


def test_a_turned_platform_has_a_turned_axis() -> None:
    turn = np.array([[np.cos(0.5), np.sin(0.5)], [-np.sin(0.5), np.cos(0.5)]])
    hall = (np.array([[-2, -0.5], [2, -0.5], [2, 0.5], [-2, 0.5]]) @ turn).tolist()
    wall = [{"start": (-9.0, -9.0), "end": (9.0, -9.0), "material": "brick"}]
    arena = Arena.create(name="turned", platform=[hall], walls=wall)
    poses = Track().walk(arena, Disc(), 300, np.random.default_rng(0)).poses
    along, across = (poses[:, :2] @ turn.T).T
    np.testing.assert_allclose(across, 0, atol=1e-6)
    assert np.ptp(along) == pytest.approx(3.6, abs=0.1)


def test_the_long_way_of_a_cross_is_one_of_its_bars() -> None:
    bars = [[(-a, -b), (a, -b), (a, b), (-a, b)] for a, b in ((2.0, 0.25), (0.25, 2.0))]
    wall = [{"start": (-9.0, -9.0), "end": (9.0, -9.0), "material": "brick"}]
    arena = Arena.create(name="cross", platform=bars, walls=wall)
    x, y, _ = Track().walk(arena, Disc(), 300, np.random.default_rng(0)).poses.T
    assert sorted([np.ptp(x), np.ptp(y)]) == pytest.approx([0.0, 3.6], abs=0.1)


def test_something_in_the_way_is_told() -> None:
    with pytest.raises(ArenaError, match="straight between"):
        run(Track(ends=((-1.5, 0.0), (1.5, 0.0))), arena="pillar")
    with pytest.raises(ArenaError, match="straight between"):
        run(Track(ends=((-1.5, 0.0), (2.5, 0.0))))
    with pytest.raises(ArenaError, match="the same place"):
        run(Track(ends=((-1.5, 0.0), (-1.5, 0.0))))


@pytest.mark.parametrize(
    "wrong", [{"speed": 0.0}, {"turn_rate": -1.0}, {"speed_spread": np.nan}, {"ends": 3}]
)
def test_bad_parameters_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ArenaError, match=next(iter(wrong))):
        Track(**wrong)
