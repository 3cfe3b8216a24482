"""What the policy does, by an eye that sees the pose itself: what maps add is tested with `Reacher`."""

from dataclasses import replace

import numpy as np
import pytest
from shapely import Point

from arena import Arena, Disc
from arena.acting import Journeys, journeys
from arena.angles import wrap_angle
from cogmap import Activity, CogmapError
from cogmap.control import MotorModel, Outcome, Reaching
from cogmap.control.steering import Steering
from cogmap.evaluation.peers.true_pose import PoseEye, TruePercept
from cogmap.experiments.acting.travels import babble, draw_poses
from cogmap.navigation.place_graph import PlaceGraph

ROOM, BODY, EYE = Arena.load("obstacles"), Disc(), PoseEye()
RNG = np.random.default_rng(0)


def images(poses: np.ndarray) -> np.ndarray:
    return EYE.render(ROOM, poses, rng=RNG)


@pytest.fixture(scope="module")
def motor() -> MotorModel:
    return babble(ROOM, EYE, TruePercept(), BODY, seed=0)


@pytest.fixture(scope="module")
def ways() -> PlaceGraph:
    return PlaceGraph(ROOM.sample_free(4000, BODY.radius, np.random.default_rng(1)))


def policy(motor: MotorModel, ways: PlaceGraph, goals: np.ndarray, **rest: object) -> Reaching:
    return Reaching(TruePercept(), ways, Steering(motor), images(goals), **rest)


def gone(go: Reaching, starts: np.ndarray, *, body: Disc = BODY, room: Arena = ROOM) -> Journeys:
    return journeys(room, go, EYE, starts, body=body, most_steps=150)


def off(ends: np.ndarray, goals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return np.linalg.norm((ends - goals)[:, :2], axis=1), np.abs(wrap_angle((ends - goals)[:, 2]))


@pytest.fixture(scope="module")
def pairs() -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(2)
    return draw_poses(ROOM, BODY.radius, 12, rng), draw_poses(ROOM, BODY.radius, 12, rng)


def test_journeys_reach_the_pose_of_an_image(motor, ways: PlaceGraph, pairs) -> None:
    starts, goals = pairs
    go = policy(motor, ways, goals)
    went = gone(go, starts)
    far, turned = off(went.poses[-1], goals)
    assert far.max() < 0.02
    assert turned.max() < np.deg2rad(0.5)
    assert (go.outcomes_ == Outcome.ARRIVED).all()
    assert go.reasons_ == [""] * 12
    assert not went.touched.any()


@pytest.mark.parametrize(
    "body",
    [Disc(swapped=True), Disc(wheel_gains=(0.7, 1.0)), Disc(delay=0.2), Disc(slip=0.05)],
    ids=["swapped", "weak", "delayed", "slip"],
)
def test_it_reaches_with_whatever_body_has_babbled(body: Disc, ways: PlaceGraph, pairs) -> None:
    starts, goals = (poses[:5] for poses in pairs)
    go = policy(babble(ROOM, EYE, TruePercept(), body, seed=0), ways, goals)
    far, turned = off(gone(go, starts, body=body).poses[-1], goals)
    assert far.max() < 0.05
    assert turned.max() < np.deg2rad(2)
    assert (go.outcomes_ == Outcome.ARRIVED).all()


def test_one_alone_goes_as_it_does_among_others(motor, ways: PlaceGraph, pairs) -> None:
    starts, goals = pairs
    together = gone(policy(motor, ways, goals[:3]), starts[:3])
    alone = policy(motor, ways, goals[1:2], single=True)
    pose, said = starts[1], []
    for step in range(int(together.steps[1])):
        command = alone({"view": images(pose[None])[0]})
        assert command is not None
        assert command.shape == (2,)
        said.append(command)
        pose = together.poses[step + 1, 1]
    np.testing.assert_allclose(said, together.commands[: len(said), 1], atol=1e-9)
    for _ in range(3):
        assert alone({"view": images(pose[None])[0]}) is None
    assert alone.outcomes_.tolist() == [Outcome.ARRIVED]


def test_a_goal_in_a_separate_part_is_unreachable_and_nobody_moves(motor) -> None:
    places = ROOM.sample_free(3000, BODY.radius, np.random.default_rng(1))
    parted = PlaceGraph(places[np.abs(places[:, 0]) > 0.5])
    goals = np.array([[1.8, 1.0, 0.0], [-1.8, 1.0, 0.0]])
    go = policy(motor, parted, goals)
    went = gone(go, np.array([[-1.8, -1.0, 0.5], [-1.8, -1.0, 0.5]]))
    assert go.outcomes_.tolist() == [Outcome.UNREACHABLE, Outcome.ARRIVED]
    assert went.steps[0] == 0
    assert "explore between" in go.reasons_[0]


@pytest.mark.parametrize("play", [0.012, 0.03])
def test_what_is_shut_in_says_that_it_is_stuck(motor, ways: PlaceGraph, play: float) -> None:
    start = np.array([[-1.5, -1.0, 0.0]])
    cell = Point(-1.5, -1.0).buffer(BODY.radius + play, quad_segs=4)
    shut = ROOM.model_copy(update={"platform": (tuple(cell.exterior.coords[:-1]),)})
    go = policy(motor, ways, np.array([[1.6, 1.0, 0.0]]))
    went = gone(go, start, room=shut)
    assert go.outcomes_.tolist() == [Outcome.STUCK]
    assert "holds it" in go.reasons_[0]
    assert went.touched.any()
    assert went.steps[0] < 60


class Fading(TruePercept):
    """Knows nothing from some look on, for as long as it lasts."""

    def __init__(self, dark: range) -> None:
        self.dark, self.looks = dark, -1

    def perceive(self, views: np.ndarray) -> Activity:
        seen = super().perceive(views)
        self.looks += 1
        if self.looks in self.dark:
            nowhere = np.full((len(views), 2), 40.0)
            return replace(seen, position=nowhere, novelty=np.full(len(views), 9.0))
        return seen


def test_who_sees_nothing_known_for_long_is_lost_and_stops(motor, ways: PlaceGraph) -> None:
    starts, goals = np.array([[-1.6, -1.0, 0.0]]), np.array([[1.6, -1.2, 0.0]])
    for dark, outcome in ((range(6, 999), Outcome.LOST), (range(6, 10), Outcome.ARRIVED)):
        go = Reaching(Fading(dark), ways, Steering(motor), images(goals))
        went = gone(go, starts)
        assert go.outcomes_.tolist() == [outcome]
        if outcome == Outcome.LOST:
            assert went.steps[0] == 5 + 9
            assert "nothing that it remembers" in go.reasons_[0]
        else:
            assert off(went.poses[-1], goals)[0][0] < 0.02


def test_goals_of_nowhere_are_refused_and_explorers_counted(motor, ways: PlaceGraph) -> None:
    goals = np.array([[1.0, 1.0, 0.0], [1.6, 1.0, 0.0]])
    with pytest.raises(CogmapError, match=r"goal 0 is nothing that this map remembers: .* 9\.0 times"):
        Reaching(Fading(range(9)), ways, Steering(motor), images(goals))
    with pytest.raises(CogmapError, match="3 explorers but 2 goals"):
        policy(motor, ways, goals)({"view": images(np.zeros((3, 3)))})
