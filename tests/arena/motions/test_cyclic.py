import numpy as np
import pytest

from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.motions.cyclic import Cyclic
from arena.rooms.arena import Arena


def poses(motion: Cyclic, views: int = 4000, arena: str = "open_field", seed: int = 0) -> np.ndarray:
    return motion.walk(Arena.load(arena), Disc(), views, np.random.default_rng(seed)).poses


@pytest.mark.parametrize("views", [1000, 4000])
def test_its_extent_is_the_long_axis_and_a_small_range_across(views: int) -> None:
    x, y, _ = poses(Cyclic(width=0.08), views).T
    # The platform is 4 m long and the body 0.36 m wide; the corridor keeps 0.04 m free.
    part = 3.56 / (views / 36 / 3)
    assert -1.78 - 1e-6 < x.min() < -1.78 + part
    assert 1.78 - 1.2 * part < x.max() < 1.78 + 1e-6
    assert np.abs(y).max() < 0.04 + 1e-9
    assert np.std(y) > 0.04 / np.sqrt(3) / 1.2


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_all_headings_occur_everywhere_on_the_way(seed: int) -> None:
    x, _, heading = poses(Cyclic(), seed=seed).T
    seen = np.histogram2d(x, heading, bins=(12, 12), range=((-1.78, 1.78), (-np.pi, np.pi)))[0]
    assert seen.min() > 5
    assert seen.std() / seen.mean() < 0.4


def test_views_follow_each_other_at_the_angle() -> None:
    found = poses(Cyclic(), 500)
    turned = np.abs(np.angle(np.exp(1j * np.diff(found[:, 2]))))
    moved = np.hypot(*np.diff(found[:, :2], axis=0).T)
    assert np.median(turned) == pytest.approx(0.175, abs=1e-6)
    # At a turn rate of 1.75 rad/s a step is half of that.
    assert turned.max() < 1.51 * 0.175
    assert moved.max() < 0.12 + 0.65 * 0.05


def test_it_goes_to_and_fro() -> None:
    found = poses(Cyclic())
    turned = np.abs(np.angle(np.exp(1j * np.diff(found[:, 2]))))
    straight = np.split(turned, np.flatnonzero(turned > 0.01))
    assert max(map(len, straight)) < 5


def test_a_slow_body_keeps_to_the_range_too() -> None:
    slow = Disc(max_acceleration=1.0, max_turn_acceleration=2.0)
    x, y, _ = Cyclic().walk(Arena.load("open_field"), slow, 4000, np.random.default_rng(0)).poses.T
    assert np.abs(y).max() < 0.07
    assert np.ptp(x) > 3.3


def test_the_way_may_be_told() -> None:
    ends = ((-0.5, -1.0), (0.5, 1.0))
    x, y, _ = poses(Cyclic(ends=ends, width=0.0), 800).T
    np.testing.assert_allclose(y, 2 * x, atol=1e-9)
    assert np.ptp(x) > 0.85


def test_in_a_narrow_corridor_the_range_is_narrower() -> None:
    wall = [{"start": (-3.0, 1.0), "end": (3.0, 1.0), "material": "brick"}]
    hall = [[(-2.5, -0.2), (2.5, -0.2), (2.5, 0.2), (-2.5, 0.2)]]
    arena = Arena.create(name="track", platform=hall, walls=wall)
    x, y, _ = Cyclic().walk(arena, Disc(), 1500, np.random.default_rng(0)).poses.T
    assert np.ptp(x) > 4.3
    assert 0.005 < np.abs(y).max() < 0.0201


def test_round_a_pillar_it_finds_a_way_past() -> None:
    found = poses(Cyclic(), 1500, "pillar")
    assert np.ptp(found[:, 0]) > 3.3
    assert np.ptp(found[:, 1]) < 0.101
    assert Arena.load("pillar").is_free(found[:, :2], 0.18).all()


def test_a_way_through_a_pillar_is_refused() -> None:
    with pytest.raises(ArenaError, match=r"straight between .*-1\.5.*; choose"):
        poses(Cyclic(ends=((-1.5, 0.0), (1.5, 0.0))), 10, "pillar")


@pytest.mark.parametrize(
    "wrong", [{"passes": 0}, {"width": -0.1}, {"view_every_rad": np.nan}, {"ends": ((0.0, 0.0),)}]
)
def test_bad_parameters_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ArenaError, match=next(iter(wrong))):
        Cyclic(**wrong)
