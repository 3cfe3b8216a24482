import numpy as np
import pytest

from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.motions.base import Walk
from arena.motions.rotation import Rotation
from arena.rooms.arena import Arena


def spin(motion: Rotation, views: int = 1000, arena: str = "open_field", body: Disc | None = None) -> Walk:
    return motion.walk(Arena.load(arena), body or Disc(), views, np.random.default_rng(0))


def gaps(headings: np.ndarray) -> np.ndarray:
    """Between neighbours on the circle."""
    return np.diff(np.sort(headings), append=headings.min() + 2 * np.pi)


def test_even_turns_are_one_place_and_all_angles() -> None:
    times, poses, *_ = spin(Rotation(position=(0.5, -0.3), turns=1, jitter=0.0, turn_rate=2.0))
    np.testing.assert_array_equal(poses[:, :2], [(0.5, -0.3)] * 1000)
    np.testing.assert_allclose(gaps(poses[:, 2]), 2 * np.pi / 1000, atol=1e-9)
    np.testing.assert_allclose(np.unwrap(poses[:, 2]) - poses[0, 2], 2.0 * times, atol=1e-9)


@pytest.mark.parametrize("turns", [1, 10])
@pytest.mark.parametrize("body", [Disc(), Disc(max_turn_acceleration=2.0)], ids=["at once", "slow"])
def test_jittered_headings_are_each_in_their_part_of_the_way(turns: int, body: Disc) -> None:
    poses = spin(Rotation(turns=turns), 1000, body=body).poses
    step = 2 * np.pi * turns / 1000
    turned = np.unwrap(poses[:, 2])
    even = turned[0] - turned[0] % 1e-9 + step * np.arange(1000)
    late = turned - even
    # All by the same unknown start, each by up to a step of its own.
    assert np.ptp(late) < step + 1e-8
    assert np.ptp(late) > 0.9 * step
    assert gaps(poses[:, 2]).max() < 2.01 * step
    assert len(np.unique(poses[:, 2])) == 1000


def test_it_never_turns_back_and_keeps_its_pace() -> None:
    times, poses, *_ = spin(Rotation(turns=3, turn_rate=1.5), 300)
    turned, lapse = np.diff(np.unwrap(poses[:, 2])), np.diff(times)
    assert (turned > 0).all()
    np.testing.assert_allclose(turned, 1.5 * lapse, atol=1e-9)
    assert times[-1] == pytest.approx(3 * 2 * np.pi / 1.5, rel=0.01)


def test_default_place_is_the_free_one_nearest_the_middle() -> None:
    np.testing.assert_array_equal(spin(Rotation(), 5).poses[:, :2], 0.0)
    x, y = spin(Rotation(), 5, "pillar").poses[0, :2]
    # A pillar of radius 0.5 m in the middle, a body of 0.18 m.
    assert np.hypot(x, y) == pytest.approx(0.68, abs=0.01)


@pytest.mark.parametrize("position", [(0.0, 0.0), (1.9, 0.0), (50.0, 0.0)])
def test_a_place_that_is_not_free_is_refused(position: tuple[float, float]) -> None:
    with pytest.raises(ArenaError, match="start"):
        spin(Rotation(position=position), 5, "pillar")


@pytest.mark.parametrize(
    "wrong", [{"turns": 0}, {"jitter": 1.1}, {"turn_rate": 0.0}, {"position": (np.nan, 0.0)}]
)
def test_bad_parameters_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ArenaError, match=next(iter(wrong))):
        Rotation(**wrong)
