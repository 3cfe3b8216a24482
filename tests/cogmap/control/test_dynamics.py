from pathlib import Path

import numpy as np
import pytest

from arena.bodies.heavy_disc import HeavyDisc
from arena.motions.babble import Babble
from arena.rooms.arena import Arena
from cogmap.control import MotorModel
from cogmap.control.motor_model import body_motion, carried
from cogmap.control.reaching import Outcome, Reaching
from cogmap.control.steering import Steering
from cogmap.evaluation.peers.true_pose import PoseEye, TruePercept
from cogmap.navigation.place_graph import PlaceGraph

BODY = HeavyDisc(mass=8.0, max_speed=0.5, inertia=0.15, max_turn=2.0)
DT = 0.2
FIELD = Arena.load("open_field")


@pytest.fixture(scope="module")
def babbled() -> tuple[np.ndarray, np.ndarray]:
    """Poses and commands of ten seconds of babbling in the open."""
    walk = Babble(start=(0.0, 0.0, 0.0)).walk(FIELD, BODY, 51, np.random.default_rng(1))
    assert walk.commands is not None
    return walk.poses, walk.commands


def looked(poses: np.ndarray) -> np.ndarray:
    return PoseEye().render(FIELD, poses, rng=np.random.default_rng(0))


def taught(poses: np.ndarray, commands: np.ndarray, order: int = 2) -> MotorModel:
    seen = TruePercept().perceive(looked(poses))
    return MotorModel(order).partial_fit(commands[:-1], seen[:-1], seen[1:])


def test_ten_seconds_of_babbling_tell_mass_and_gain(babbled: tuple[np.ndarray, np.ndarray]) -> None:
    model = taught(*babbled)
    kept = np.exp(-DT / np.array(BODY.lags))
    np.testing.assert_allclose(model.persistence_[[0, 2], [0, 2]], kept, atol=0.01)
    np.testing.assert_allclose(
        model.total_, [[DT * BODY.max_speed, 0], [0, 0], [0, DT * BODY.max_turn]], atol=2e-3
    )
    assert taught(*babbled, order=1).noise_[0] > 20 * model.noise_[0]


def test_five_decisions_are_foretold(babbled: tuple[np.ndarray, np.ndarray]) -> None:
    poses, commands = babbled
    position, phase = poses[20:21, :2], poses[20:21, 2]
    motion = body_motion(poses[19:20, :2], poses[19:20, 2], position, phase)
    for step in taught(poses, commands).roll_out(commands[20:25, None], commands[19:20], motion):
        position, phase = carried(position, phase, step)
    np.testing.assert_allclose(position, poses[25:26, :2], atol=3e-3)
    np.testing.assert_allclose(phase, poses[25:26, 2], atol=3e-3)


def test_what_is_learnt_is_saved_and_merged(babbled: tuple[np.ndarray, np.ndarray], tmp_path: Path) -> None:
    model = taught(*babbled)
    model.save(tmp_path / "motor")
    loaded = MotorModel.load(tmp_path / "motor")
    assert loaded.order == 2
    np.testing.assert_array_equal(loaded.persistence_, model.persistence_)
    np.testing.assert_allclose(loaded.merge(model).total_, model.total_, atol=1e-9)


def test_commands_that_go_on_bring_about_the_total(babbled: tuple[np.ndarray, np.ndarray]) -> None:
    model, full = taught(*babbled), np.array([[1.0, 0.5]])
    np.testing.assert_allclose(model.predict(full), full @ model.total_.T, atol=1e-9)
    lasting = model.roll_out(np.tile(full, (60, 1, 1)), np.zeros((1, 2)), np.zeros((1, 3)))
    np.testing.assert_allclose(lasting[-1], full @ model.total_.T, atol=1e-5)


def test_it_brakes_in_time(babbled: tuple[np.ndarray, np.ndarray]) -> None:
    ways = PlaceGraph(FIELD.sample_free(3000, BODY.radius, np.random.default_rng(0)))
    goal = np.array([[1.0, 0.3, 0.5]])
    go = Reaching(TruePercept(), ways, Steering(taught(*babbled)), looked(goal))
    drive = BODY.place(FIELD, (-1.2, 0.0, 0.0))
    for _ in range(8):
        drive.step(BODY.max_speed, 0.0, DT)
    for _ in range(150):
        pose = np.array([drive.pose])
        command = go({"view": looked(pose)})
        assert command is not None
        if np.isnan(command).all():
            break
        speed, turn = BODY.velocities(command[0])
        drive.step(float(speed), float(turn), DT)
    assert go.outcomes_[0] == Outcome.ARRIVED
    assert np.linalg.norm(pose[0, :2] - goal[0, :2]) < 0.03
    assert abs(drive.speed) < 0.02
