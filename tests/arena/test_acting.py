import json

import numba
import numpy as np
import pytest

from arena.acting import Journeys, journeys
from arena.bodies.arm import Arm
from arena.bodies.disc import Disc
from arena.environment import Explorer
from arena.errors import ArenaError
from arena.exploration import explore
from arena.eye.base import AnyEye
from arena.eye.camera import Camera
from arena.eye.overhead import Overhead
from arena.motions.policy import Policy, Sensed
from arena.rooms.arena import Arena
from arena.smell.nose import Nose

ROOM = Arena.load("pillar")
EYE = Camera.panoramic(16, 4, noise=0.05)
BODY = Disc(slip=0.1, delay=0.1)
STARTS = np.column_stack([ROOM.sample_free(20, 0.23, np.random.default_rng(0)), np.linspace(-3, 3, 20)])


def by_sight(sensed: Sensed) -> np.ndarray:
    """Turn by what is seen and smelt."""
    bright = sensed["view"].mean(axis=(-3, -2, -1)) / 255
    return np.stack([bright, np.tanh(sensed["odour"][..., 0]) - 0.5], axis=-1)


def go(policy: Policy = by_sight, starts: np.ndarray = STARTS, steps: int = 12) -> Journeys:
    return journeys(ROOM, policy, EYE, starts, nose=Nose(), body=BODY, most_steps=steps, seed=5)


def test_a_journey_is_that_of_the_environment_bit_by_bit() -> None:
    env = Explorer(ROOM, camera=EYE, body=BODY, dt=0.2)
    found = go(starts=STARTS[:1])
    env.np_random = np.random.default_rng(np.random.SeedSequence(5).spawn(1)[0])
    sensed, truth = env.reset(options={"pose": STARTS[0]})
    for step in range(12):
        np.testing.assert_array_equal(found.poses[step, 0], truth["pose"])
        command = by_sight(sensed)
        np.testing.assert_array_equal(found.commands[step, 0], command)
        sensed, _, _, _, truth = env.step(command)
        assert found.touched[step, 0] == truth["touched"]
    np.testing.assert_array_equal(found.poses[12, 0], truth["pose"])
    np.testing.assert_array_equal(found.times, 0.2 * np.arange(13))


def test_journeys_are_the_same_whoever_goes_beside_and_with_any_number_of_threads() -> None:
    threads, found = numba.get_num_threads(), go()
    numba.set_num_threads(1)
    again = go()
    numba.set_num_threads(threads)
    few = go(starts=STARTS[:3])
    for name in ("poses", "commands", "touched"):
        np.testing.assert_array_equal(getattr(again, name), getattr(found, name))
        np.testing.assert_array_equal(getattr(few, name), getattr(found, name)[:, :3])


def test_who_has_stopped_stands_still_and_is_heard_no_more() -> None:
    asked: list[Sensed] = []

    def policy(sensed: Sensed) -> np.ndarray:
        asked.append(sensed)
        commands = np.full((3, 2), 0.4)
        # The first stops for one step only, the second later, the third never starts.
        commands[[len(asked) == 3, len(asked) >= 5, True]] = np.nan
        return commands

    found = go(policy, STARTS[:3])
    np.testing.assert_array_equal(found.steps, [2, 4, 0])
    assert found.commands.shape == (4, 3, 2)
    assert len(asked) == 5
    for k, steps in enumerate(found.steps):
        assert np.isfinite(found.commands[:steps, k]).all()
        assert np.isnan(found.commands[steps:, k]).all()
        np.testing.assert_array_equal(found.poses[steps:, k], np.tile(found.poses[steps, k], (5 - steps, 1)))
        assert not found.touched[steps:, k].any()
    assert (np.diff(found.poses[1:5, 1, :2], axis=0) != 0).any(axis=1).all()
    # What it sensed last is shown again, without new noise.
    np.testing.assert_array_equal(asked[4]["view"][0], asked[2]["view"][0])
    assert not np.array_equal(asked[4]["view"][1], asked[3]["view"][1])


def test_those_who_never_go_have_no_steps() -> None:
    found = go(lambda sensed: np.full((len(sensed["view"]), 2), np.nan))
    assert found.commands.shape == (0, 20, 2)
    np.testing.assert_allclose(found.poses[0], STARTS)


@pytest.mark.parametrize(
    ("said", "message"),
    [
        (np.zeros(2), "shape"),
        (np.zeros((3, 2)), "shape"),
        (np.full((20, 2), np.inf), "not finite"),
        (np.tile([np.nan, 0.0], (20, 1)), "not finite"),
    ],
)
def test_commands_that_mean_nothing(said: np.ndarray, message: str) -> None:
    with pytest.raises(ArenaError, match=message):
        go(lambda sensed: said)  # noqa: ARG005


def test_bad_numbers() -> None:
    for fields in ({"most_steps": 0}, {"seed": -1}, {"dt": 0.0}, {"starts": np.zeros((0, 3))}):
        given = {"starts": STARTS, "most_steps": 1, **fields}
        with pytest.raises(ArenaError):
            journeys(ROOM, by_sight, EYE, **given)


@pytest.mark.parametrize("eye", [Camera.panoramic(16, 4, noise=0.05), Overhead(16, 16, noise=0.05)])
def test_arms_go_together_as_alone(eye: AnyEye) -> None:
    arm, room = Arm(slip=0.05, motor_gains=(0.7, 1.0)), Arena.load("obstacles")
    starts = arm.sample_free(room, 6, np.random.default_rng(0))

    def gone(starts: np.ndarray) -> Journeys:
        return journeys(room, by_sight, eye, starts, body=arm, most_steps=8, seed=3)

    found, few = gone(starts), gone(starts[:2])
    np.testing.assert_array_equal(few.joints, found.joints[:, :2])
    np.testing.assert_allclose(found.joints[0], starts)
    np.testing.assert_array_equal(found.poses[-1], arm.camera_poses(found.joints[-1]))
    assert found.commands.shape == (8, 6, 2)
    assert go().joints is None


def test_a_policy_may_change_what_it_is_shown_in_place() -> None:
    def meddling(sensed: Sensed) -> np.ndarray:
        command = by_sight(sensed)
        sensed["view"][:] = 0
        return command

    plain, meddled = (
        explore(ROOM, policy, EYE, body=BODY, views=np.int64(4), seed=np.int64(1), start=STARTS[0])
        for policy in (by_sight, meddling)
    )
    np.testing.assert_array_equal(plain.views, meddled.views)
    np.testing.assert_array_equal(plain.poses, meddled.poses)
    assert json.loads(json.dumps(dict(plain.attributes)))["seed"] == 1
