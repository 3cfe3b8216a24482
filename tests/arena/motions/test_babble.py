import numpy as np
import pytest

from arena import Arena, Arm, Babble, Camera, Disc, Neck, Nose, Rail, explore, journeys

ROOM = Arena.load("pillar")
OPEN = Arena.load("furnished")
EYE = Camera.panoramic(8, 2)
START = (1.5, 0.0, 0.0)


def test_commands_are_smooth_and_of_every_kind() -> None:
    babble = Babble(speed=0.3, turn=0.2)
    policy = babble.policy(np.random.default_rng(0), 50)
    said = np.array([policy({}) for _ in range(400)])
    np.testing.assert_allclose(said.std(axis=(0, 1)), [0.3, 0.2], rtol=0.05)
    np.testing.assert_allclose(said.mean(axis=(0, 1)), 0, atol=0.02)
    for lag in (1, 3):
        found = [np.corrcoef(said[lag:, :, k].ravel(), said[:-lag, :, k].ravel())[0, 1] for k in (0, 1)]
        assert found == pytest.approx([np.exp(-0.2 * lag / 0.6)] * 2, abs=0.02)
    each = said[:, :, 0].T
    assert np.abs(np.corrcoef(each) - np.eye(50)).max() < 0.5
    assert np.abs([Babble().policy(np.random.default_rng(0), 500)({}) for _ in range(9)]).max() == 1


def test_a_walk_is_what_its_policy_does() -> None:
    babble = Babble(start=START)
    walk = babble.walk(ROOM, Disc(), 60, np.random.default_rng(3))
    gone = journeys(ROOM, babble.policy(np.random.default_rng(3), 1), EYE, np.array([START]), most_steps=60)
    np.testing.assert_array_equal(walk.poses, gone.poses[:60, 0])
    np.testing.assert_array_equal(walk.commands, gone.commands[:, 0])
    np.testing.assert_array_equal(walk.times, gone.times[:60])


def test_many_babble_at_once_and_meet_walls() -> None:
    starts = np.column_stack([ROOM.sample_free(8, 0.23, np.random.default_rng(0)), np.zeros(8)])
    policy = Babble().policy(np.random.default_rng(0), 8)
    gone = journeys(ROOM, policy, EYE, starts, most_steps=50)
    assert gone.commands.shape == (50, 8, 2)
    assert (gone.steps == 50).all()
    assert 0 < gone.touched.mean() < 0.5
    assert len(np.unique(gone.commands[0], axis=0)) == 8


def test_the_recording_has_the_commands() -> None:
    rec = explore(ROOM, Babble(), EYE, nose=Nose(noise=0.0))
    assert len(rec) == 400
    before, after = rec.poses[:-1], rec.poses[1:]
    gone, course = np.diff(rec.poses[:, :2], axis=0), (before[:, 2] + after[:, 2]) / 2
    ahead = gone[:, 0] * np.cos(course) + gone[:, 1] * np.sin(course)
    # At walls it goes less far than it is told.
    told = 0.2 * Disc().max_speed * rec.without_truth().commands[:-1, 0]
    straight = np.abs(rec.commands[:-1, 1]) < 0.2
    assert np.mean(np.abs(ahead - told)[straight] < 1e-3) > 0.6


def test_joints_are_looked_through_by_how_far_they_go_and_commands_say_how() -> None:
    arm = Arm()
    walk = Babble(swing_every=50).walk(OPEN, arm, 400, np.random.default_rng(0))
    gone = np.diff(np.unwrap(walk.poses, axis=0), axis=0)
    told = arm.velocities(walk.commands)[:-1] * np.diff(walk.times)[:, None]
    np.testing.assert_allclose(gone, told, atol=1e-9)
    length = np.hypot(*gone.T)
    assert length.max() < 0.1 + 1e-9
    assert np.mean(length > 0.1 - 1e-9) > 0.9
    assert np.abs(walk.commands).max() == 1
    # All the way of a swing the commands stay the same, at full speed.
    swinging = (np.abs(walk.commands).max(axis=1) == 1) & (np.arange(400) >= 50)
    steady = swinging[1:] & (np.abs(np.diff(walk.commands, axis=0)).max(axis=1) < 1e-9)
    assert steady.sum() > 40


def test_swings_end_anywhere_and_go_straight_the_short_way() -> None:
    walk = Babble(swing_every=1).walk(OPEN, Arm(), 800, np.random.default_rng(1))
    turning = np.abs(np.diff(walk.commands, axis=0)).max(axis=1) > 1e-6
    ends = walk.poses[:-1][turning]
    # Evenly on either circle: no quarter is left out.
    for joint in ends.T:
        assert np.histogram(joint, 4, (-np.pi, np.pi))[0].min() > 0.1 * len(ends)
    there = np.unwrap(walk.poses, axis=0)[:-1][turning]
    assert np.abs(np.diff(there, axis=0)).max() < np.pi + 0.1


def test_at_an_end_or_an_obstacle_it_turns_round() -> None:
    for body, every in ((Arm(limits="both"), 0.1), (Rail(length=0.5), 0.05)):
        there = Babble(swing_every=10_000).walk(OPEN, body, 400, np.random.default_rng(2)).poses
        assert body.is_free(OPEN, there).all()
        still = (np.abs(np.diff(there, axis=0)).max(axis=1) < 0.01 * every).mean()
        assert still < 0.05


def test_a_neck_babbles_with_all_its_motors_without_swings() -> None:
    walk = Babble(swing_every=10).walk(OPEN, Neck(), 200, np.random.default_rng(0))
    assert (walk.poses.shape, walk.commands.shape) == ((200, 4), (200, 3))
    assert np.abs(np.diff(walk.commands, axis=0)).max() < 1.5
    assert (walk.commands.std(axis=0) > 0.2).all()


def test_it_begins_where_told() -> None:
    walk = Babble(start=(0.3, -0.4)).walk(OPEN, Arm(), 3, np.random.default_rng(0))
    np.testing.assert_allclose(walk.poses[0], [0.3, -0.4])
