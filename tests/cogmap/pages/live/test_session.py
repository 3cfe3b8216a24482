import inspect
from copy import copy

import numpy as np
import pytest

from arena import Camera
from arena.errors import ArenaError
from cogmap.errors import CogmapError
from cogmap.pages.live import mind as mind_module
from cogmap.pages.live.mind import Mind
from cogmap.pages.live.session import DECISION, Doing, Session
from cogmap.pages.live.world import World

GOAL = (1.1, 0.4, 2.0)


def test_it_stands_where_it_is_put_and_its_map_believes_so(session: Session) -> None:
    session.stand(-0.6, 0.3, 1.2)
    look = session.look()
    np.testing.assert_allclose(session.pose, (-0.6, 0.3, 1.2), atol=1e-9)
    np.testing.assert_allclose(look.ghost[:2], (-0.6, 0.3), atol=0.12)
    assert look.errors[0] == pytest.approx(np.linalg.norm(look.ghost[:2] - session.pose[:2]))
    assert abs(look.errors[1]) < np.deg2rad(5)
    session.turn(-2.0)
    np.testing.assert_allclose(session.pose, (-0.6, 0.3, -2.0), atol=1e-9)


def test_where_it_does_not_fit_it_stays(session: Session) -> None:
    before = session.pose
    session.stand(2.6, 0.0, 0.0)
    np.testing.assert_array_equal(session.pose, before)
    assert "does not fit" in session.said


def test_it_is_driven_and_the_border_stops_it(session: Session) -> None:
    session.stand(1.5, 0.0, 0.0)
    session.drive(1.0, 0.0)
    for _ in range(40):
        session.step(0.05)
    look = session.look()
    assert session.doing is Doing.DRIVEN
    assert look.touched
    assert session.pose[0] == pytest.approx(2 - 0.18, abs=0.01)
    session.drive(0.0, 0.0)
    assert session.doing is Doing.STANDING
    assert not session.step(0.05)


def test_a_page_that_slept_does_not_leap(session: Session) -> None:
    session.stand(0.0, 0.0, 0.0)
    session.drive(1.0, 0.0)
    session.step(100.0)
    assert 0 < session.pose[0] < 0.1


def test_it_goes_to_an_image_by_sight_alone(session: Session) -> None:
    session.stand(-1.0, -0.6, 0.0)
    session.aim(*GOAL)
    assert session.doing is Doing.GOING, session.said
    np.testing.assert_allclose(session.route[[0, -1]], [(-1.0, -0.6), GOAL[:2]], atol=0.1)
    for _ in range(1200):
        session.step(0.05)
        if session.doing is not Doing.GOING:
            break
    assert session.said == "arrived"
    assert np.linalg.norm(session.pose[:2] - GOAL[:2]) < 0.1
    assert len(session.dreamt) > 2
    assert session.dreamt[0].shape == session.world.mind.cmap.view_shape_
    session.stop()
    assert session.goal is None
    assert session.dreamt == []


def test_the_policy_is_asked_once_a_decision_and_told_views_and_odours_alone(session: Session) -> None:
    told = []

    def policy(sensed: dict[str, np.ndarray]) -> np.ndarray:
        told.append({name: values.shape for name, values in sensed.items()})
        return np.array([0.2, 0.1])

    session.stand(0.0, 0.0, 0.0)
    session.doing, session._policy, session._since = Doing.GOING, policy, DECISION
    for _ in range(8):
        session.step(DECISION / 4)
    assert told == [{"view": (15, 90, 3), "odour": (3,)}] * 2


def test_the_mind_is_handed_no_pose() -> None:
    assert "arena" not in {
        line.split()[1].split(".")[0]
        for line in inspect.getsource(mind_module).splitlines()
        if line.startswith(("from ", "import "))
    }
    for name in ("look", "sniff", "way"):
        assert "pose" not in str(inspect.signature(getattr(Mind, name)))


def test_in_the_dark_the_nose_is_left(session: Session) -> None:
    session.stand(0.4, 0.2, 0.5)
    lit = session.look()
    session.light(on=False)
    dark = session.look()
    assert not dark.view.any()
    assert np.isnan(dark.ghost[2])
    assert np.linalg.norm(dark.ghost[:2] - session.pose[:2]) < 1.0
    assert dark.thought.point is None
    assert len(dark.thought.nearest) == 0
    assert dark.thought.dreamt is not None
    assert dark.thought.dreamt.unusual is None
    session.light(on=True)
    np.testing.assert_array_equal(session.look().view, lit.view)


def test_a_box_that_is_moved_surprises(session: Session) -> None:
    session.stand(-0.9, 0.5, 2.4)
    before = session.look().thought.dreamt
    session.move_box(0, -1.3, 1.65)
    after = session.look().thought.dreamt
    assert session.said == ""
    assert before is not None
    assert after is not None
    assert before.unusual is not None
    assert after.unusual is not None
    assert after.unusual.max() > 1.5 * before.unusual.max()
    assert Session(session.world).room is session.world.room
    session.tidy()
    again = session.look().thought.dreamt
    assert again is not None
    np.testing.assert_array_equal(again.unusual, before.unusual)


def test_a_box_cannot_be_put_onto_the_explorer(session: Session) -> None:
    session.stand(0.0, 0.0, 0.0)
    session.move_box(0, 0.0, 0.0)
    assert "stays where it was" in session.said
    assert session.room is session.world.room
    session.move_box(7, 0.0, 0.0)
    assert "no box 7; the room has 1" in session.said


def test_a_recording_is_replayed_and_scrubbed(session: Session) -> None:
    walk = session.world.walk
    session.replayed("walk")
    session.scrub(100)
    look = session.look()
    assert look.pose is not None
    np.testing.assert_array_equal(look.view, walk.views[100])
    np.testing.assert_allclose(look.pose, walk.poses[100])
    session.play(on=True)
    for _ in range(20):
        session.step(0.1)
    gone = walk.times[session.at] - walk.times[100]
    assert gone == pytest.approx(2.0, abs=2 * np.diff(walk.times).max())
    session.scrub(10**9)
    assert session.at == len(walk) - 1
    session.replayed("")
    assert session.doing is Doing.STANDING
    session.replayed("another")
    assert "choose among walk" in session.said


def test_without_a_motor_model_it_goes_nowhere_and_says_so(world: World) -> None:
    mind = Mind(world.mind.cmap, memory=world.walk.views)
    session = Session(World(world.room, world.camera, world.body, mind, world.walk))
    session.aim(*GOAL)
    assert session.doing is Doing.STANDING
    assert "--motor" in session.said


def test_where_nothing_is_known_it_does_not_dream_of_the_way_and_gives_up(session: Session) -> None:
    session.stand(-1.0, -0.6, 0.0)
    session.light(on=False)
    session.aim(*GOAL)
    assert session.doing is Doing.GOING
    assert "does not dream" in session.said
    assert len(session.route) == 0
    for _ in range(200):
        session.step(0.1)
    assert session.doing is Doing.STANDING
    assert "nothing that it remembers" in session.said


def test_a_goal_must_be_free(session: Session) -> None:
    session.aim(2.9, 0.0, 0.0)
    assert "does not fit" in session.said


def test_a_world_needs_poses_and_the_camera_of_the_map(world: World) -> None:
    with pytest.raises(CogmapError, match="no poses"):
        World(world.room, world.camera, world.body, world.mind, world.walk.without_truth())
    with pytest.raises(CogmapError, match="60×360 pixels but the map was learnt from 15×90"):
        World(world.room, Camera.panoramic(), world.body, world.mind, world.walk)


def test_a_map_that_does_not_imagine_says_why(world: World) -> None:
    plain = copy(world.mind.cmap)
    plain.relaxed_places_, plain.refine_reason_ = None, "never shown views"
    mind = Mind(plain, memory=world.walk.views)
    assert mind.reason == "never shown views"
    session = Session(World(world.room, world.camera, world.body, mind, world.walk))
    look = session.look()
    assert look.thought.dreamt is None
    assert np.isfinite(look.ghost).all()
    session.aim(*GOAL)
    assert session.said == "never shown views"


def test_a_memory_of_other_views_is_perceived_anew(world: World) -> None:
    other = Mind(world.mind.cmap, memory=world.walk.views[:500])
    known = world.mind.cmap.perceive(world.walk.views[:500])
    np.testing.assert_allclose(other.places.position, known.position, atol=1e-6)
    own = world.mind.places
    np.testing.assert_array_equal(own.position, world.mind.cmap.relaxed_places_.places_)


def test_sessions_of_the_same_seed_begin_alike(world: World) -> None:
    np.testing.assert_array_equal(Session(world, seed=3).pose, Session(world, seed=3).pose)
    with pytest.raises(ArenaError):
        Session(world, seed=3)._begun(world.room, np.array([9.0, 9.0, 0.0]))
