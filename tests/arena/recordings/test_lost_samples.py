import numpy as np
import pytest
from jaxtyping import Bool

from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.motions.brownian import Brownian
from arena.recordings.lost_samples import equal_to, jumps, sentinel, too_fast
from arena.rooms.arena import Arena


def path(count: int = 2000, rate: float = 25.0) -> tuple[np.ndarray, np.ndarray]:
    t = np.arange(count) / rate
    return t, np.stack([250 + 150 * np.sin(t), 220 + 150 * np.sin(1.37 * t)], axis=1)


def fewest_lost(times: np.ndarray, positions: np.ndarray, fastest: float) -> int:
    """By trying all that can come before each sample."""
    longest = np.ones(len(times), dtype=int)
    for late in range(len(times)):
        for early in range(late):
            way = np.hypot(*(positions[late] - positions[early]))
            if way <= fastest * (times[late] - times[early]):
                longest[late] = max(longest[late], longest[early] + 1)
    return len(times) - int(longest.max())


def test_only_both_coordinates_are_a_missing_value() -> None:
    positions = np.array([(0, 0), (0, 5), (5, 0), (1023, 1023), (1023, 767), (np.nan, 0), (-0.0, 0)])
    assert equal_to(positions, [0.0]).tolist() == [True, False, False, False, False, False, True]
    assert np.flatnonzero(equal_to(positions, [1023.0, (1023.0, 767.0)])).tolist() == [3, 4]
    assert not equal_to(positions, []).any()


@pytest.mark.parametrize("seed", range(25))
def test_the_fewest_samples_are_too_fast(seed: int) -> None:
    rng = np.random.default_rng(seed)
    t = np.arange(40) / 10
    positions = np.cumsum(rng.normal(0, 0.02, (40, 2)), axis=0)
    wrong = rng.random(40) < 0.12
    positions[wrong] += rng.normal(0, 0.7, (wrong.sum(), 2))
    lost = too_fast(t, positions, 1.0)
    assert lost.sum() == fewest_lost(t, positions, 1.0)
    speed = np.hypot(*np.diff(positions[~lost], axis=0).T) / np.diff(t[~lost])
    assert speed.max(initial=0) <= 1


def test_a_steady_speed_is_not_too_fast_and_what_is_lost_stays_so() -> None:
    t = np.arange(50) / 10
    positions = np.stack([0.3 * t, 0 * t], axis=1)
    assert not too_fast(t, positions, 0.3).any()
    positions[20] = 7
    positions[30] = np.nan
    assert np.flatnonzero(too_fast(t, positions, 0.3)).tolist() == [20]
    # Lost for so long that it is looked for beyond many stretches.
    many = np.arange(9000) / 1000
    away = np.stack([0 * many, 0 * many], axis=1)
    away[3000:6000] = np.random.default_rng(0).uniform(50, 99, (3000, 2))
    assert np.array_equal(np.flatnonzero(too_fast(many, away, 1.0)), np.arange(3000, 6000))


def test_an_error_within_reach_of_one_neighbour_goes_alone() -> None:
    t = np.arange(60) / 10
    positions = np.stack([0.5 * t, 0 * t], axis=1)
    positions[30, 0] = positions[29, 0] - 0.09
    assert np.flatnonzero(too_fast(t, positions, 1.0)).tolist() == [30]


def test_an_error_that_creeps_back_is_kept_from_where_it_can_be_reached() -> None:
    along = np.zeros(66)
    along[30:36] = 0.5, 0.42, 0.34, 0.26, 0.18, 0.1
    lost = too_fast(np.arange(66) / 10, np.stack([along, 0 * along], axis=1), 1.0)
    # The last one before them may go in place of the third.
    assert np.flatnonzero(lost).tolist() in ([29, 30, 31], [30, 31, 32])


def test_a_speed_that_half_of_the_path_exceeds_is_refused() -> None:
    with pytest.raises(ArenaError, match=r"1999 of 1999 steps are faster; half of all go at \d+ m/s"):
        too_fast(*path(), 1.0)


@pytest.mark.parametrize("share", [0.002, 0.05, 0.2])
@pytest.mark.parametrize("pair", [(1023, 1023), (0, 0), (-1, -1), (640, 480), (250, 220)])
def test_an_undeclared_sentinel_is_found_exactly(share: float, pair: tuple[int, int]) -> None:
    t, positions = path()
    lost = np.random.default_rng(3).random(len(t)) < share
    lost[[0, 1, 400, 401, 402, -1]] = True
    positions[lost] = pair
    found = jumps(t, positions)
    np.testing.assert_array_equal(found, lost)
    assert sentinel(positions, found) == (*pair, lost.sum())


def test_two_sentinels_and_single_errors_are_found() -> None:
    t, positions = path()
    wrong = {
        1: (950, 2),
        5: (900, 3),
        100: (0, 0),
        300: (0, 0),
        301: (1023, 1023),
        500: (1023, 1023),
        1700: (2, 950),
    }
    wrong |= {99: (1023, 1023)}
    for at, place in wrong.items():
        positions[at] = place
    found = jumps(t, positions)
    assert np.flatnonzero(found).tolist() == sorted(wrong)
    assert sentinel(positions, found) == (1023, 1023, 3)
    single = np.zeros(len(t), dtype=bool)
    single[5] = True
    assert sentinel(positions, single) is None
    assert sentinel(positions, ~found & False) is None


def test_an_animal_that_is_lost_once_for_long_may_come_back_elsewhere() -> None:
    t, positions = path()
    positions[590:650] = 0
    way = np.hypot(*(positions[650] - positions[589]))
    assert way > 0.5 * np.hypot(*positions[[589, 650]].T).min()
    assert np.flatnonzero(jumps(t, positions)).tolist() == list(range(590, 650))


def still(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """A sleeping animal, whose pixel flickers."""
    positions = np.full((3000, 2), 100.0)
    positions[rng.random(3000) < 0.02] += (1, 0)
    return np.arange(3000) / 25, positions


def resting(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """It rests nearly always, and runs to and fro now and then."""
    run = np.concatenate([np.linspace(0, 1, 30), np.linspace(1, 0, 30)])
    along = np.concatenate([np.zeros(3000), run, np.zeros(3000), run])
    return np.arange(len(along)) / 25, np.stack([along, 0 * along], axis=1) + rng.normal(0, 5e-4, (6120, 2))


def dashing(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """It is seen seldom, and crosses its cage between four samples."""
    rest, there, back = np.zeros(200), np.linspace(0, 1, 4), np.linspace(1, 0, 4)
    along = np.concatenate([rest, there, 1 + rest, back, rest])
    return np.arange(len(along)) / 5, np.stack([along, 0 * along], axis=1) + rng.normal(0, 1e-3, (608, 2))


def walking(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    walk = Brownian().walk(Arena.load("open_field"), Disc(), 1000, rng)
    return walk.times, np.round(50 * walk.poses[:, :2])


@pytest.mark.parametrize("kind", [still, resting, dashing, walking])
def test_animals_are_not_doubted(kind) -> None:
    assert not jumps(*kind(np.random.default_rng(0))).any()


def test_samples_that_are_missing_are_not_doubted_and_short_paths_are_left_alone() -> None:
    t, positions = path()
    positions[50:60], positions[200, 1] = np.nan, np.nan
    found: Bool[np.ndarray, " samples"] = jumps(t, positions)
    assert not found.any()
    assert not jumps(t[:4], np.array([(0, 0), (0, 1), (99, 99), (0, 1.0)])).any()
    assert not jumps(t[:20], np.zeros((20, 2))).any()
