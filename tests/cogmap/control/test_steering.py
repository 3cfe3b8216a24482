import numpy as np
import pytest

from cogmap import CogmapError
from cogmap.control import MotorModel
from cogmap.control.steering import Steering
from tests.cogmap.control.test_motor_model import perceived


def steering(now: np.ndarray, late: np.ndarray | None = None, *, noise: float = 0.0) -> Steering:
    """Of a body that answers to commands in this way."""
    late = np.zeros((3, 2)) if late is None else late
    rng = np.random.default_rng(0)
    commands, previous = rng.uniform(-1, 1, (2, 200, 2))
    forward, left, turn = (commands @ now.T + previous @ late.T + noise * rng.standard_normal((200, 3))).T
    step = (forward + 1j * left) * np.exp(0.5j * turn)
    after = np.column_stack([step.real, step.imag, turn])
    model = MotorModel().partial_fit(
        commands, perceived(np.zeros((200, 3))), perceived(after), previous=previous
    )
    return Steering(model)


def rotated(response: np.ndarray, angle: float) -> np.ndarray:
    """The same, on a map whose north lies otherwise."""
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    return turn @ response


BODIES = {
    "plain": np.array([[0.2, 0], [0, 0], [0, 0.6]]),
    "north elsewhere": rotated(np.array([[0.2, 0], [0, 0], [0, 0.6]]), 2.0),
    "mirrored": np.array([[0.2, 0], [0, 0], [0, -0.6]]),
    "numbers exchanged, one backwards": np.array([[0, -0.2], [0, 0], [0.6, 0]]),
    "wheels": np.array([[0.1, 0.1], [0, 0], [-0.3, 0.3]]),
    "one wheel weak": np.array([[0.1, 0.07], [0, 0], [-0.3, 0.21]]),
}


@pytest.mark.parametrize("name", BODIES)
def test_what_is_commanded_is_what_was_wanted(name: str) -> None:
    body, steer = BODIES[name], steering(BODIES[name])
    wanted = np.random.default_rng(1).uniform(-0.3, 0.3, (20, 2)) * [steer.pace, steer.turn]
    forward, left, turn = (steer.command(*wanted.T) @ body.T).T
    along = (forward + 1j * left) * np.exp(-1j * steer.course)
    np.testing.assert_allclose(along, wanted[:, 0], atol=1e-9)
    np.testing.assert_allclose(turn, wanted[:, 1], atol=1e-9)


@pytest.mark.parametrize("name", BODIES)
def test_what_is_too_much_is_cut_and_the_turn_comes_first(name: str) -> None:
    body, steer = BODIES[name], steering(BODIES[name])
    turns = np.array([0.0, 0.6, -0.9, 5.0]) * steer.turn
    commands = steer.command(np.full(4, 10 * steer.pace), turns)
    assert np.abs(commands).max() <= 1 + 1e-12
    np.testing.assert_allclose((commands @ body.T)[:, 2], np.clip(turns, -steer.turn, steer.turn), atol=1e-9)
    gone = np.linalg.norm((commands @ body.T)[:, :2], axis=1)
    assert gone[0] == pytest.approx(steer.pace)
    assert (gone[1:] < steer.pace).any() or name in {"plain", "north elsewhere", "mirrored"}


def test_pace_and_turn_are_the_most_that_the_body_can() -> None:
    plain = steering(BODIES["plain"])
    assert (plain.pace, plain.turn) == pytest.approx((0.2, 0.6))
    assert abs(np.sin(plain.course)) < 1e-9
    weak = steering(BODIES["one wheel weak"])
    # the weak wheel at its most, the other one slower: both go straight
    assert weak.pace == pytest.approx(2 * 0.07)
    assert weak.close == pytest.approx(0.04 * weak.pace)


def test_what_comes_late_counts_as_much() -> None:
    late = np.array([[0.1, 0], [0, 0], [0, 0.3]])
    steer = steering(0.5 * late, late)
    assert (steer.pace, steer.turn) == pytest.approx((0.15, 0.45))


@pytest.mark.parametrize(
    "body",
    [np.array([[0.2, 0], [0, 0], [0, 0]]), np.array([[0.0, 0], [0, 0], [0, 0.6]]), np.zeros((3, 2))],
    ids=["cannot turn", "cannot go", "does nothing"],
)
def test_a_body_that_does_not_answer_is_refused(body: np.ndarray) -> None:
    with pytest.raises(CogmapError, match="hardly move or turn"):
        steering(body, noise=1e-3)
