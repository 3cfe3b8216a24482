import numpy as np
import pytest

from arena.bodies.arm import Arm
from arena.bodies.rail import Rail
from arena.errors import ArenaError
from arena.rooms.arena import Arena

OPEN = Arena.load("furnished")
BOX = {"center": (1.0, 0.9), "size": (0.4, 0.4), "height": 0.5, "material": "oak"}
BOXED = OPEN.model_copy(update={"boxes": (BOX,)})
RNG = np.random.default_rng
ONE = np.zeros(1, int)


def stepped(body: Arm, velocities: list[float], seed: int = 0) -> np.ndarray:
    at_large = body.at_large(OPEN, 1)
    at_large.begin(ONE, np.array([[0.5, 1.0]]))
    at_large.step(ONE, np.array([velocities]), 0.1, [RNG(seed)])
    return at_large.configurations[0] - [0.5, 1.0]


def test_motors_are_weak_and_slip_as_told() -> None:
    np.testing.assert_allclose(stepped(Arm(), [1.0, -0.5]), [0.1, -0.05])
    np.testing.assert_allclose(stepped(Arm(motor_gains=(0.7, 1.0)), [1.0, -0.5]), [0.07, -0.05])
    noise = RNG(3).standard_normal(2)
    np.testing.assert_allclose(stepped(Arm(slip=0.05), [1.0, 1.0], 3), 0.1 * (1 + 0.05 * noise))


def test_nobody_slips_when_nobody_goes() -> None:
    at_large = Arm(slip=0.05).at_large(OPEN, 1)
    at_large.begin(ONE, np.array([[0.5, 1.0]]))
    at_large.step(ONE[:0], np.empty((0, 2)), 0.1, [])
    np.testing.assert_array_equal(at_large.configurations, [[0.5, 1.0]])


def test_commands_are_shares_of_what_motors_can_do() -> None:
    np.testing.assert_allclose(Arm(max_turn=2.0).velocities(np.array([[0.5, -7.0]])), [[1.0, -2.0]])


def test_what_is_lower_is_passed_over_and_what_is_higher_is_not() -> None:
    over_it = np.array([[np.arctan2(0.9, 1.0), 0.0]])
    for height, free in ((0.3, False), (0.5, True), (0.0, False)):
        assert Arm(height=height).is_free(BOXED, over_it).item() == free
    assert Arm().is_free(OPEN, over_it).item()


def test_nothing_is_free_inside_a_solid() -> None:
    inside = Arm(links=(0.05, 0.05), width=0.05, base=(1.0, 0.9))
    assert not inside.is_free(BOXED, np.zeros((1, 2))).any()
    assert inside.is_free(OPEN, np.zeros((1, 2))).all()
    with pytest.raises(ArenaError, match="hardly ever free"):
        inside.sample_free(BOXED, 3, RNG(0))


def test_what_moves_is_free_where_it_is_stopped() -> None:
    arm = Arm()
    starts = arm.sample_free(BOXED, 60, RNG(0))
    at_large, everyone = arm.at_large(BOXED, 60), np.arange(60)
    at_large.begin(everyone, starts)
    touched = np.zeros(60, bool)
    for step in range(25):
        at_large.step(everyone, RNG(step // 5).uniform(-2, 2, (60, 2)), 0.2, [])
        assert arm.is_free(BOXED, at_large.configurations).all()
        touched |= at_large.touched
    assert 0.05 < touched.mean() < 0.9


def test_free_configurations_are_drawn_evenly() -> None:
    rail = Rail(length=2.0, start=(0.0, 0.9))
    drawn = rail.sample_free(BOXED, 2000, RNG(0))[:, 0]
    assert not ((drawn > 0.722) & (drawn < 1.278)).any()
    share = np.mean(drawn < 0.72)
    assert share == pytest.approx(0.72 / (0.72 + 0.72), abs=0.04)
    assert (drawn.min(), drawn.max()) == pytest.approx((0.0, 2.0), abs=0.01)


def test_a_range_ends_what_is_free() -> None:
    assert Rail(length=2.0).is_free(OPEN, np.array([[-0.01], [0.0], [2.0], [2.01]])).tolist() == [
        False, True, True, False
    ]  # fmt: skip


def test_one_gain_for_each_motor() -> None:
    with pytest.raises(ArenaError, match="1 gains for 2 motors"):
        Arm(motor_gains=(0.7,))
