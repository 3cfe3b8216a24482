import numpy as np
import pytest

from arena import Arena, Arm, Babble, Body, Camera, Rail, explore
from arena.acting import Journeys
from cogmap.control import Outcome
from cogmap.coordinates import GeneralisedCoordinates
from cogmap.experiments import Conditions, Result
from cogmap.experiments.bodies.body_trial import BodyTrial
from cogmap.experiments.bodies.joint_reaching import OBSTACLES, _scored, _summary, joint_reaching

ROOM = Arena.load("furnished")


@pytest.mark.parametrize("body", [Rail(), Arm(limits="one"), Arm(links=(0.5, 0.4, 0.3))])
def test_other_bodies_than_an_arm_of_two_free_links_are_left_out(body: Body) -> None:
    eye = Camera.panoramic(90, 15)
    walk = explore(ROOM, Babble(), eye, body=body, views=3, seed=0)
    trial = BodyTrial(body, walk, walk, GeneralisedCoordinates())
    found = joint_reaching(trial, Conditions(ROOM, 100), eye)
    assert found == Result({})


def test_ends_are_off_around_the_circle_and_ways_over_the_shortest() -> None:
    """One ends .4° away across the seam, having gone twice as far as needed; the other 2° away, straight."""
    starts, goals = np.array([[3.0, 1.0], [0.5, 1.0]]), np.array([[-3.0, 1.0], [1.5, 1.0]])
    ends = goals + np.deg2rad([[-0.4, 0.1], [0.0, 2.0]])
    back = starts - np.array([[0.5 * (2 * np.pi - 6), 0], [0, 0]])
    there = np.stack([starts, back, ends])
    room, gone = np.zeros((3, 2, 3)), np.zeros((2, 2), bool)
    gone[0, 1] = True
    ways = Journeys(np.arange(3.0), room, np.zeros((2, 2, 2)), gone, np.full(2, 2), there)
    empty = ROOM.model_copy(update={"boxes": ()})
    table = _scored(empty, Arm(), ways, goals, np.array([Outcome.ARRIVED, Outcome.STUCK]))
    np.testing.assert_allclose(
        table[["error_1_deg", "error_2_deg"]], np.array([[0.4, 0.1], [0.0, 2.0]]), atol=1e-9
    )
    np.testing.assert_allclose(table["way_rad"] / table["shortest_rad"], [2, 1], rtol=0.03)
    assert list(table["touched"]) == [False, True]
    assert list(table["outcome"]) == ["arrived", "stuck"]
    summed = _summary(table)
    assert (summed["reached_1deg"], summed["reached_half_deg"]) == (0.5, 0.5)


def test_obstacles_leave_the_base_free_and_are_within_reach() -> None:
    among = ROOM.model_copy(update={"boxes": (*ROOM.boxes, *OBSTACLES)})
    postures = np.random.default_rng(0).uniform(-np.pi, np.pi, (500, 2))
    free, before = (Arm().is_free(room, postures) for room in (among, ROOM))
    assert before.all()
    assert 0.5 < free.mean() < 0.9
