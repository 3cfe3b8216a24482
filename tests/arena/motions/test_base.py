from collections.abc import Callable

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from arena import (
    Arena,
    ArenaError,
    Babble,
    Brownian,
    Chemotaxis,
    Cyclic,
    Disc,
    HeavyDisc,
    Motion,
    Rotation,
    Track,
    gallery,
)
from arena.motions.base import Striding

MOTIONS = [Brownian(), Rotation(), Cyclic(), Chemotaxis(), Track(), Babble()]
SLOW = Disc(max_acceleration=1.0, max_turn_acceleration=2.0)


def name(motion: Motion) -> str:
    return type(motion).__name__


@pytest.mark.parametrize(
    ("motion", "views"), [(Rotation(), 5_000), (Cyclic(), 4_000), (Brownian(), 17_000)], ids=name
)
def test_table_1_of_the_paper_needs_no_number(motion: Motion, views: int) -> None:
    walk = motion.walk(Arena.load("furnished"), Disc(), None, np.random.default_rng(0))
    assert walk.times.shape == (views,)
    assert walk.poses.shape == (views, 3)


@pytest.mark.parametrize("motion", MOTIONS, ids=name)
def test_same_seed_same_arrays(motion: Motion) -> None:
    arena = Arena.load("pillar")
    first, again, other = (motion.walk(arena, Disc(), 400, np.random.default_rng(seed)) for seed in (0, 0, 1))
    np.testing.assert_array_equal(first.times, again.times)
    np.testing.assert_array_equal(first.poses, again.poses)
    assert first.notes == again.notes
    assert not np.array_equal(first.poses, other.poses)


@pytest.mark.parametrize("body", [Disc(), SLOW], ids=["at once", "slow"])
@pytest.mark.parametrize("motion", [Brownian(), Track(), Cyclic()], ids=name)
def test_strides_are_short_and_go_on_where_the_last_ended(motion: Striding, body: Disc) -> None:
    arena = Arena.load("pillar")
    strides = list(motion.strides(arena, body, 600, np.random.default_rng(0)))
    assert [len(stride.times) for stride in strides] == [256, 256, 88]
    walk = motion.walk(arena, body, 600, np.random.default_rng(0))
    np.testing.assert_array_equal(np.concatenate([stride.poses for stride in strides]), walk.poses)
    # As in one go: the way between two views is no other where a stride ends.
    lapse = np.diff(walk.times)
    assert lapse[[255, 511]].min() > 0
    assert lapse[[255, 511]].max() <= np.delete(lapse, [255, 511]).max()
    if isinstance(motion, Brownian | Track):
        shorter = motion.walk(arena, body, 300, np.random.default_rng(0))
        np.testing.assert_array_equal(shorter.poses, walk.poses[:300])
        np.testing.assert_array_equal(shorter.times, walk.times[:300])


@pytest.mark.parametrize("body", [Disc(radius=0.12), SLOW], ids=["at once", "slow"])
@pytest.mark.parametrize("motion", MOTIONS, ids=name)
@settings(max_examples=6, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.integers(0, 2**32))
def test_every_pose_is_free(
    motion: Motion, body: Disc, random_room: Callable[[int], Arena], seed: int
) -> None:
    arena = random_room(seed)
    try:
        walk = motion.walk(arena, body, 150, np.random.default_rng(seed))
    except ArenaError as error:
        assert "free space" in str(error)  # noqa: PT017
        assert arena.free_space(body.radius).area < 1e-6
        return
    places = shapely.points(walk.poses[:, :2])
    assert shapely.distance(arena.free_space(body.radius), places).max() < 1e-3
    assert (np.diff(walk.times) >= 0).all()
    assert walk.times[0] == 0 or name(motion) == "Rotation"
    assert (np.abs(walk.poses[:, 2]) <= np.pi).all()


@pytest.mark.parametrize("room", gallery())
@pytest.mark.parametrize("motion", MOTIONS, ids=name)
def test_every_room_of_the_gallery_can_be_walked(motion: Motion, room: str) -> None:
    arena = Arena.load(room)
    poses = motion.walk(arena, Disc(), 400, np.random.default_rng(0)).poses
    assert shapely.distance(arena.free_space(0.18), shapely.points(poses[:, :2])).max() < 1e-3
    if name(motion) in {"Cyclic", "Track"}:
        assert np.hypot(*np.ptp(poses[:, :2], axis=0)) > 1.5


@pytest.mark.parametrize("motion", MOTIONS, ids=name)
def test_no_motion_is_faster_than_its_body(motion: Motion) -> None:
    body = Disc(max_speed=0.2, max_turn=0.5)
    walk = motion.walk(Arena.load("open_field"), body, 300, np.random.default_rng(0))
    lapse = np.diff(walk.times)
    assert (np.hypot(*np.diff(walk.poses[:, :2], axis=0).T) <= 0.2 * lapse + 1e-9).all()
    turned = np.abs(np.angle(np.exp(1j * np.diff(walk.poses[:, 2]))))
    assert (turned <= 0.5 * lapse + 1e-9).all()


@pytest.mark.parametrize(
    "body",
    [Disc(slip=0.2, wheel_gains=(0.7, 1.0), swapped=True, delay=0.13), HeavyDisc()],
    ids=["disturbed", "heavy"],
)
@pytest.mark.parametrize("motion", MOTIONS, ids=name)
def test_motions_go_on_whatever_the_body_makes_of_them(motion: Motion, body: Disc) -> None:
    arena = Arena.load("obstacles")
    first, again = (motion.walk(arena, body, 60, np.random.default_rng(0)).poses for _ in range(2))
    np.testing.assert_array_equal(first, again)
    assert shapely.distance(arena.free_space(0.18), shapely.points(first[:, :2])).max() < 1e-3
    assert np.ptp(first[:, 2]) > 0.1


@pytest.mark.parametrize("motion", MOTIONS, ids=name)
def test_body_that_fits_nowhere_is_refused(motion: Motion) -> None:
    with pytest.raises(ArenaError, match="free space"):
        motion.walk(Arena.load("open_field"), Disc(radius=1.6), 10, np.random.default_rng(0))
