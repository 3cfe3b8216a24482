import numpy as np
import pytest

from arena import Arena, Camera, Disc
from arena.acting import journeys
from cogmap.control.steering import Steering
from cogmap.evaluation.peers.image_descent import ImageDescent, catchment, rotational_difference
from cogmap.evaluation.peers.true_pose import PoseEye, TruePercept
from cogmap.experiments.acting.travels import babble

ROOM = Arena.load("open_field")


def test_the_least_difference_over_turns_is_found() -> None:
    rng = np.random.default_rng(0)
    first, second = rng.integers(0, 256, (2, 3, 8, 36, 3)).astype(np.uint8)
    found = rotational_difference(first, second)
    for one, other, rms in zip(first.astype(float), second.astype(float), found.rms, strict=True):
        brute = min(np.sqrt(np.square(one - np.roll(other, k, axis=1)).mean()) for k in range(36))
        # a parabola goes a little below its three columns
        assert 0.95 * brute < rms <= brute + 1e-3


@pytest.mark.parametrize("turn", [0.0, 0.6, -2.5])
def test_a_turn_is_told_and_leaves_no_difference(turn: float) -> None:
    camera = Camera.panoramic(180, 30)
    there = camera.render(ROOM, np.array([[0.4, 0.3, 1.0]]))
    here = camera.render(ROOM, np.array([[0.4, 0.3, 1.0 - turn]]))
    found = rotational_difference(here, there)
    assert found.turn[0] == pytest.approx(turn, abs=np.deg2rad(0.5))
    assert found.rms[0] < 8
    away = camera.render(ROOM, np.array([[-1.0, 0.3, 1.0]]))
    assert rotational_difference(away, there).rms[0] > 3 * found.rms[0]


def test_descent_leads_to_more_alike_views_looks_as_the_goal_does_and_stops(camera: Camera) -> None:
    motor = babble(ROOM, PoseEye(), TruePercept(), Disc(), seed=0)
    goals = np.array([[0.3, 0.2, 1.0]] * 8)
    starts = goals + np.random.default_rng(0).uniform([-0.4, -0.4, -3], [0.4, 0.4, 3], (8, 3))
    images = camera.render(ROOM, goals)
    gone = journeys(ROOM, ImageDescent(images, Steering(motor)), camera, starts, body=Disc(), most_steps=200)
    before, after = (rotational_difference(camera.render(ROOM, gone.poses[k]), images) for k in (0, -1))
    assert np.median(after.rms) < 0.9 * np.median(before.rms)
    assert np.abs(after.turn).max() < np.deg2rad(1)
    assert gone.steps.max() < 200


def test_a_bowl_catches_all_and_a_second_one_its_own_side() -> None:
    y, x = np.mgrid[:9, :12].astype(float)
    bowl = np.hypot(x - 3, y - 4)
    assert catchment(bowl, (4, 3)).all()
    two = np.minimum(bowl, np.hypot(x - 10, y - 4) + 0.5)
    caught = catchment(two, (4, 3))
    assert caught[:, :6].all()
    assert not caught[:, 8:].any()
    wall = bowl.copy()
    wall[:, 6] = np.nan
    caught = catchment(wall, (4, 3))
    assert caught[:, :6].all()
    assert not caught[:, 6:].any()
