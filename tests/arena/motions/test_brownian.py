import numpy as np
import pytest
import shapely

from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.motions.base import Walk
from arena.motions.brownian import STEP, Brownian
from arena.rooms.arena import Arena


def walk(motion: Brownian, views: int, arena: str = "open_field", seed: int = 0) -> Walk:
    return motion.walk(Arena.load(arena), Disc(), views, np.random.default_rng(seed))


def turns(poses: np.ndarray) -> np.ndarray:
    return np.abs(np.angle(np.exp(1j * np.diff(poses[:, 2]))))


@pytest.mark.parametrize("arena", ["open_field", "pillar"])
@pytest.mark.parametrize("seed", [0, 1])
def test_17000_views_cover_place_and_heading_evenly(arena: str, seed: int) -> None:
    poses = walk(Brownian(), 17_000, arena, seed).poses
    low, high = np.array([-1.82, -1.32, -np.pi]), np.array([1.82, 1.32, np.pi])
    seen, (x, y, _) = np.histogramdd(poses, bins=(6, 5, 8), range=list(zip(low, high, strict=True)))
    free = Arena.load(arena).free_space(0.18)
    cells = [[shapely.box(x[i], y[j], x[i + 1], y[j + 1]) for j in range(5)] for i in range(6)]
    room = np.vectorize(lambda cell: cell.intersection(free).area / cell.area)(np.array(cells))
    density = (seen / np.maximum(room, 0.01)[..., None])[room > 0.2]
    assert seen.sum() == 17_000
    assert density.min() > 10
    assert density.std() / density.mean() < 0.35
    # At the very border too: headings into it, along it, away from it.
    east = poses[poses[:, 0] > 1.8, 2]
    assert np.histogram(np.abs(east), bins=4, range=(0, np.pi))[0].min() > 0.1 * len(east)
    assert len(east) > 200


def test_views_follow_each_other_at_the_spacing() -> None:
    motion = Brownian()
    times, poses, *_ = walk(motion, 3000)
    moved, turned = np.hypot(*np.diff(poses[:, :2], axis=0).T), turns(poses)
    assert times[0] == 0
    assert (np.diff(times) > 0).all()
    assert moved.max() < motion.view_every_m + Disc().max_speed * STEP
    assert turned.max() < motion.view_every_rad + Disc().max_turn * STEP
    straight = (turned < 0.1) & (moved > 0.09)
    assert straight.mean() > 0.2
    # A wall may cut the last step short.
    assert moved[straight].min() > motion.view_every_m - Disc().max_speed * STEP
    assert np.median(moved[straight]) == pytest.approx(motion.view_every_m, abs=0.015)
    on_the_spot = moved < 1e-9
    assert 0.1 < on_the_spot.mean() < 0.5
    assert np.median(turned[on_the_spot]) == pytest.approx(motion.view_every_rad, abs=1e-6)


def test_body_stays_in_free_space_and_within_its_speed() -> None:
    times, poses, *_ = walk(Brownian(), 2000, "pillar")
    free = Arena.load("pillar").free_space(0.18)
    assert shapely.distance(free, shapely.points(poses[:, :2])).max() < 1e-3
    speed = np.hypot(*np.diff(poses[:, :2], axis=0).T) / np.diff(times)
    assert speed.max() < Disc().max_speed + 1e-9
    assert (np.abs(poses[:, 2]) <= np.pi).all()


def test_same_seed_same_walk() -> None:
    first, again, other = walk(Brownian(), 500), walk(Brownian(), 500), walk(Brownian(), 500, seed=1)
    np.testing.assert_array_equal(first.times, again.times)
    np.testing.assert_array_equal(first.poses, again.poses)
    assert not np.array_equal(first.poses, other.poses)


def test_longer_walk_begins_like_a_shorter_one() -> None:
    np.testing.assert_array_equal(walk(Brownian(), 300).poses[:100], walk(Brownian(), 100).poses)


def test_without_wandering_and_spins_it_goes_straight_until_a_wall() -> None:
    motion = Brownian(wander=0.0, spin_probability=0.0, start=(-1.5, 0.2, 0.0))
    poses = walk(motion, 20).poses
    np.testing.assert_allclose(poses[:, 1:], [(0.2, 0.0)] * 20, atol=1e-12)
    assert poses[0].tolist() == [-1.5, 0.2, 0.0]


@pytest.mark.parametrize("start", [(0.0, 0.0, 0.0), (2.5, 0.0, 0.0)])
def test_start_inside_a_pillar_or_off_the_platform_is_refused(start: tuple[float, float, float]) -> None:
    with pytest.raises(ArenaError, match="start"):
        walk(Brownian(start=start), 10, "pillar")


def test_body_that_fits_nowhere_is_refused() -> None:
    with pytest.raises(ArenaError, match="no free space"):
        Brownian().walk(Arena.load("open_field"), Disc(radius=1.6), 10, np.random.default_rng(0))


@pytest.mark.parametrize(
    "wrong",
    [
        {"speed": 0.0},
        {"run_length": -1.0},
        {"spin_probability": 1.1},
        {"view_every_rad": np.nan},
        {"view_every_m": np.inf},
    ],
)
def test_bad_parameters_are_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ArenaError, match=next(iter(wrong))):
        Brownian(**wrong)
