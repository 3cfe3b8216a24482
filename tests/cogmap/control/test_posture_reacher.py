"""A turntable and its eye: images reached through its motor, and what is said where they are not."""

import numpy as np
import pytest

from arena import Arena, Babble, Camera, Policy, Recording, Turntable, explore
from arena.acting import journeys
from arena.angles import wrap_angle
from cogmap import CogmapError
from cogmap.control import Outcome, PostureReacher, posture_reaching
from cogmap.control.posture_reaching import REASONS
from cogmap.features.image_codes import image_codes

ROOM, EYE = Arena.load("furnished"), Camera.panoramic(45, 8)


def encode(views: np.ndarray) -> np.ndarray:
    return image_codes(views, width=10, height=3)


WEAK = Turntable(motor_gains=(0.6,))


@pytest.fixture(scope="module")
def babbled() -> Recording:
    return explore(ROOM, Babble(), EYE, body=WEAK, views=500, seed=0)


@pytest.fixture(scope="module")
def reacher(babbled: Recording) -> PostureReacher:
    return PostureReacher(encode, babbled.views, babbled.require("commands"), babbled.times)


def image(angles: np.ndarray) -> np.ndarray:
    return EYE.render(ROOM, WEAK.camera_poses(angles))


def test_images_are_reached_the_short_way(reacher: PostureReacher) -> None:
    starts, goals = (np.random.default_rng(seed).uniform(-np.pi, np.pi, (6, 1)) for seed in (1, 2))
    go = reacher.towards(image(goals))
    assert isinstance(go, Policy)
    gone = journeys(ROOM, go, EYE, starts, body=WEAK, most_steps=100)
    assert gone.joints is not None
    assert (go.outcomes_ == Outcome.ARRIVED).all()
    assert go.reasons_ == [""] * 6
    assert np.rad2deg(np.abs(wrap_angle(gone.joints[-1] - goals))).max() < 0.5
    way = np.abs(wrap_angle(np.diff(gone.joints, axis=0))).sum(axis=0)
    assert np.median(way / np.abs(wrap_angle(goals - starts))) < 1.1


def test_each_goes_as_if_alone(reacher: PostureReacher) -> None:
    starts, goals = np.array([[0.0], [1.0]]), np.array([[2.0], [-1.0]])
    both = journeys(ROOM, reacher.towards(image(goals)), EYE, starts, body=WEAK, most_steps=30)
    alone = journeys(ROOM, reacher.towards(image(goals[:1])), EYE, starts[:1], body=WEAK, most_steps=30)
    steps = alone.steps[0]
    np.testing.assert_array_equal(both.commands[:steps, 0], alone.commands[:steps, 0])


def test_one_goal_makes_a_policy_for_one(reacher: PostureReacher) -> None:
    view = image(np.array([[0.4]]))[0]
    go = reacher.towards(view)
    for _ in range(2):
        command = go({"view": view})
    assert command is None
    assert go.outcomes_.tolist() == [Outcome.ARRIVED]


def test_who_does_not_move_is_kicked_then_stuck(
    reacher: PostureReacher, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(posture_reaching, "STALLED", 3)
    here, goal = image(np.array([[0.4], [2.0]]))
    go, commands = reacher.towards(goal), []
    while (command := go({"view": here})) is not None:
        commands.append(command[0])
    assert go.outcomes_.tolist() == [Outcome.STUCK]
    assert min(commands) < 0 < max(commands)
    assert len(commands) == 4 * (posture_reaching.KICKS + 1) - 1
    assert go.reasons_ == [REASONS[Outcome.STUCK]]


def test_who_sees_nothing_known_is_lost(reacher: PostureReacher) -> None:
    noise = np.random.default_rng(0).integers(0, 256, (8, 45, 3)).astype(np.uint8)
    go = reacher.towards(image(np.array([[0.4]]))[0])
    while go({"view": noise}) is not None:
        pass
    assert go.outcomes_.tolist() == [Outcome.LOST]


def test_without_a_way_a_goal_is_unreachable(babbled: Recording) -> None:
    """Two halves of a turn whose codes lie far apart."""

    def torn(views: np.ndarray) -> np.ndarray:
        codes = encode(views)
        return np.column_stack([codes, 1e5 * (codes[:, 0] > np.median(encode(babbled.views)[:, 0]))])

    first, second = (babbled.views[view] for view in np.argsort(encode(babbled.views)[:, 0])[[0, -1]])
    reacher = PostureReacher(torn, babbled.views, babbled.require("commands"), babbled.times)
    go = reacher.towards(second)
    assert go({"view": first}) is None
    assert go.outcomes_.tolist() == [Outcome.UNREACHABLE]


def test_bad_input_is_told(reacher: PostureReacher, babbled: Recording) -> None:
    with pytest.raises(CogmapError, match="pixels"):
        reacher.towards(np.zeros((4, 4, 3), np.uint8))
    with pytest.raises(CogmapError, match="2 explorers but 1 goals"):
        reacher.towards(babbled.views[:1])({"view": babbled.views[:2]})
    short = PostureReacher(encode, babbled.views, babbled.require("commands")[:5], babbled.times[:5])
    with pytest.raises(CogmapError, match="times"):
        short.towards(babbled.views[0])
