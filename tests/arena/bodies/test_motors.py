import math

import numpy as np
import pytest

from arena.bodies.disc import Disc, Drive
from arena.bodies.motors import Motors
from arena.errors import ArenaError
from arena.rooms.arena import Arena

OPEN = Arena.load("open_field")
RNG = np.random.default_rng


def poses(drive: Drive, commands: np.ndarray, dt: float = 0.05) -> np.ndarray:
    found = [drive.pose]
    for speed, turn in commands.tolist():
        drive.step(speed, turn, dt)
        found.append(drive.pose)
    return np.array(found)


def some(count: int = 60) -> np.ndarray:
    return RNG(0).uniform((-0.3, -2), (0.3, 2), (count, 2))


def placed(body: Disc, seed: int = 0) -> Drive:
    return body.place(OPEN, (0.1, 0.2, 0.3), RNG(seed))


def test_motors_that_nothing_disturbs_are_those_of_the_plain_body() -> None:
    starts = [(x, y, 1.0) for x, y in OPEN.sample_free(5, 0.18, RNG(0)).tolist()]
    states = np.array([(*start, 0.0, 0.0, math.nan) for start in starts])
    motors, drives = Motors(Disc(), OPEN, 5), [Disc().place(OPEN, start) for start in starts]
    for step in range(40):
        commands = RNG(step).uniform(-1, 1, (5, 2))
        motors.move(states, np.arange(5), commands, 0.2, [])
        for drive, command in zip(drives, commands.tolist(), strict=True):
            drive.step(*command, 0.2)
    np.testing.assert_array_equal(states[:, :2], [drive.pose[:2] for drive in drives])


def test_delay_of_whole_steps_shifts_the_way_by_as_many() -> None:
    commands = some()
    late = poses(placed(Disc(delay=0.2)), commands)
    np.testing.assert_array_equal(late[:5], np.tile(late[0], (5, 1)))
    np.testing.assert_array_equal(late[4:], poses(placed(Disc()), commands)[:-4])


def test_delay_within_a_step_and_beyond_it() -> None:
    for delay in (0.03, 0.13):
        gone = poses(placed(Disc(delay=delay)), np.tile([0.4, 0.0], (8, 1)))[:, :2] - [0.1, 0.2]
        wanted = 0.4 * np.maximum(0, 0.05 * np.arange(9) - delay)
        np.testing.assert_allclose(np.hypot(*gone.T), wanted, atol=1e-12)


def test_contact_in_any_part_of_a_step_is_told() -> None:
    drive = Disc(delay=0.1).place(OPEN, (1.72, 0.0, 0.0))
    assert not drive.step(0.6, 0.0, 0.2)
    assert not drive.step(-0.6, 0.0, 0.01)
    # The wall is met in the first part, then the body goes back.
    assert drive.step(-0.6, 0.0, 0.2)
    assert drive.contact == pytest.approx(np.pi)
    assert drive.speed < 0


def test_swapped_wheels_mirror_the_way() -> None:
    plain, swapped = (poses(placed(body), some(20)) for body in (Disc(), Disc(swapped=True)))
    np.testing.assert_allclose(swapped[:, 2] - 0.3, 0.3 - plain[:, 2], atol=1e-12)
    ahead, aside = [np.cos(0.3), np.sin(0.3)], [-np.sin(0.3), np.cos(0.3)]
    np.testing.assert_allclose(swapped[:, :2] @ ahead, plain[:, :2] @ ahead, atol=1e-12)
    centre = np.array([0.1, 0.2]) @ aside
    np.testing.assert_allclose(swapped[:, :2] @ aside - centre, centre - plain[:, :2] @ aside, atol=1e-12)


def test_a_weak_wheel_drives_in_a_circle() -> None:
    body = Disc(wheel_gains=(0.7, 1.0))
    drive = placed(body)
    drive.step(0.2, 0.0, 0.1)
    speed, turn = body.from_wheels(0.7 * 0.2, 0.2)
    assert drive.pose[2] == pytest.approx(0.3 + 0.1 * turn)
    assert math.dist(drive.pose[:2], (0.1, 0.2)) == pytest.approx(0.1 * speed)
    assert (drive.speed, drive.turn) == (0.2, 0.0)


def test_slip_is_of_each_wheel_and_from_the_generator_alone() -> None:
    body = Disc(slip=0.05)
    turned, again, other = (poses(placed(body, seed), np.tile([0.1, 0.5], (9, 1))) for seed in (0, 0, 1))
    np.testing.assert_array_equal(turned, again)
    assert not np.array_equal(turned, other)
    draws, drive = RNG(0).standard_normal((9, 2)), placed(body)
    for left, right in 1 + 0.05 * draws:
        before = drive.pose[2]
        drive.step(0.1, 0.5, 0.05)
        rims = (0.1 - 0.5 * 0.115) * left, (0.1 + 0.5 * 0.115) * right
        assert drive.pose[2] - before == pytest.approx(0.05 * body.from_wheels(*rims)[1])
    with pytest.raises(ArenaError, match="give `rng`"):
        body.place(OPEN, (0.0, 0.0, 0.0))


def test_who_begins_anew_has_no_command_on_its_way() -> None:
    states = np.tile([0.0, 0.0, 0.0, 0.0, 0.0, math.nan], (2, 1))
    motors = Motors(Disc(delay=0.1), OPEN, 2)
    both = np.arange(2)
    motors.move(states, both, np.full((2, 2), 0.3), 0.15, [])
    begun = states[:, 0].copy()
    motors.begin(both[:1])
    motors.move(states, both, np.zeros((2, 2)), 0.1, [])
    assert states[0, 0] == begun[0]
    assert states[1, 0] > begun[1]


@pytest.mark.parametrize(
    "fields", [{"slip": -0.1}, {"wheel_gains": (0.0, 1.0)}, {"wheel_gains": (1.0,)}, {"delay": math.inf}]
)
def test_bad_disturbances_are_one_sentence(fields: dict[str, object]) -> None:
    with pytest.raises(ArenaError, match="Disc: "):
        Disc(**fields)
