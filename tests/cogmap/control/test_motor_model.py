from pathlib import Path

import numpy as np
import pytest

from arena.angles import wrap_angle
from cogmap import Activity, CogmapError
from cogmap.control import MotorModel

NOW = np.array([[0.2, 0.05], [0.0, 0.01], [-0.1, 0.6]])
LATE = np.array([[0.04, 0.0], [0.0, 0.0], [0.0, 0.1]])


def perceived(poses: np.ndarray) -> Activity:
    nothing = np.empty((len(poses), 0), np.float32)
    return Activity(nothing, nothing, wrap_angle(poses[:, 2]), nothing, poses[:, :2])


def babbled(steps: int, seed: int = 0, *, noise: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Commands, and the poses before, between and after them, of a body with these responses."""
    rng = np.random.default_rng(seed)
    commands = rng.uniform(-1, 1, (steps, 2))
    late = np.concatenate([np.zeros((1, 2)), commands[:-1]])
    forward, left, turn = (commands @ NOW.T + late @ LATE.T).T
    heading = np.concatenate([[0.3], 0.3 + np.cumsum(turn)])
    step = (forward + 1j * left) * np.exp(1j * (heading[:-1] + turn / 2))
    place = np.concatenate([[0], np.cumsum(step)])
    poses = np.column_stack([place.real, place.imag, heading])
    return commands, poses + noise * rng.standard_normal(poses.shape)


def taught(commands: np.ndarray, poses: np.ndarray) -> MotorModel:
    return MotorModel().partial_fit(commands, perceived(poses[:-1]), perceived(poses[1:]))


def test_a_known_response_is_found_and_foretold() -> None:
    commands, poses = babbled(100)
    model = taught(commands, poses)
    np.testing.assert_allclose(model.response_, [NOW, LATE], atol=1e-9)
    assert model.noise_.max() < 1e-6
    turn = np.diff(poses[:, 2])
    # along the chord of the arc
    step = (np.diff(poses[:, 0]) + 1j * np.diff(poses[:, 1])) * np.exp(-1j * (poses[:-1, 2] + turn / 2))
    moved = np.column_stack([step.real, step.imag, turn])
    np.testing.assert_allclose(model.predict(commands[1:], commands[:-1]), moved[1:], atol=1e-9)
    np.testing.assert_allclose(model.predict(commands[1:]), commands[1:] @ (NOW + LATE).T, atol=1e-9)


def test_steps_that_a_wall_or_a_slip_spoilt_count_less() -> None:
    commands, poses = babbled(300, noise=1e-3)
    before, after = poses[:-1], poses[1:].copy()
    after[::6, :2] = before[::6, :2]  # held by a wall
    after[1::20, 2] += 0.7  # slipped round
    model = MotorModel().partial_fit(commands, perceived(before), perceived(after))
    np.testing.assert_allclose(model.response_, [NOW, LATE], atol=3e-3)
    assert 0.5e-3 < model.noise_.min() < model.noise_.max() < 4e-3


def test_the_command_before_each_can_be_told() -> None:
    commands, poses = babbled(120)
    rows = np.random.default_rng(1).permutation(np.arange(1, 120))
    before, after = perceived(poses[:-1][rows]), perceived(poses[1:][rows])
    model = MotorModel().partial_fit(commands[rows], before, after, previous=commands[rows - 1])
    np.testing.assert_allclose(model.response_, [NOW, LATE], atol=1e-9)


@pytest.mark.parametrize("shared", ["merged", "learnt on"])
def test_models_that_each_learnt_half_are_as_one_that_learnt_all(shared: str) -> None:
    halves = [babbled(400, seed, noise=2e-3) for seed in (0, 1)]
    one, other = (taught(*half) for half in halves)
    first = one.response_
    if shared == "merged":
        noise = np.maximum(one.noise_, other.noise_)
        one.merge(other)
        np.testing.assert_array_equal(one.noise_, noise)
    else:
        commands, poses = halves[1]
        one.partial_fit(commands, perceived(poses[:-1]), perceived(poses[1:]))
    truth = np.array([NOW, LATE])
    mean = (first + other.response_) / 2
    np.testing.assert_allclose(one.response_, mean, atol=0.2 * np.abs(first - truth).max())
    assert np.abs(one.response_ - first).max() > 0


def test_commands_that_were_never_given_do_nothing() -> None:
    commands, poses = babbled(100)
    commands[:, 1] = 0
    forward = np.cumsum(0.2 * commands[:, 0])
    poses = np.column_stack([np.concatenate([[0], forward]), np.zeros((101, 2))])
    np.testing.assert_allclose(taught(commands, poses).response_[:, :, 1], 0, atol=1e-9)


def test_a_model_is_saved_and_loaded_with_equal_bits(tmp_path: Path) -> None:
    model = taught(*babbled(100, noise=1e-3))
    model.save(tmp_path / "motor")
    loaded = MotorModel.load(tmp_path / "motor")
    np.testing.assert_array_equal(loaded.response_, model.response_)
    np.testing.assert_array_equal(loaded.noise_, model.noise_)
    more, poses = babbled(80, 1)
    for each in (model, loaded):
        each.partial_fit(more, perceived(poses[:-1]), perceived(poses[1:]))
    np.testing.assert_array_equal(loaded.response_, model.response_)
    with pytest.raises(CogmapError, match="exists already"):
        model.save(tmp_path / "motor")
    with pytest.raises(CogmapError, match="cannot read a motor"):
        MotorModel.load(tmp_path)


def test_bad_input_is_refused() -> None:
    commands, poses = babbled(60)
    before, after = perceived(poses[:-1]), perceived(poses[1:])
    with pytest.raises(CogmapError, match="has learnt nothing yet"):
        MotorModel().response_  # noqa: B018
    with pytest.raises(CogmapError, match="60 commands but 59 views after"):
        MotorModel().partial_fit(commands, before, after[1:])
    with pytest.raises(CogmapError, match="29 steps teach no motor model"):
        MotorModel().partial_fit(commands[:30], before[:30], after[:30])
    unknown = perceived(np.column_stack([np.full((60, 2), np.nan), np.zeros(60)]))
    with pytest.raises(CogmapError, match="no positions or no headings"):
        MotorModel().partial_fit(commands, before, unknown)
