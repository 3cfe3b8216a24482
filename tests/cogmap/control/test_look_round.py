import numpy as np
import pytest

from cogmap import CogmapError
from cogmap.control.look_round import LookRound
from cogmap.features.image_codes import image_codes
from cogmap.navigation.hypotheses import SceneMemory

TURN = np.array([0.0, 0.15])
STEPS = 40


def view(angle: float, *, marked: bool) -> np.ndarray:
    """An image that is the same from opposite places, but for a blue field seen from about one of them."""
    image = np.zeros((15, 20, 3), np.uint8)
    image[:, :10] = 128 + 100 * np.cos(2 * angle)
    image[:, 10:] = 128 + 100 * np.sin(2 * angle)
    if marked and np.cos(angle) > 0.6:
        image[:, :, 2] = 255
    return image


def memory(*, marked: bool) -> SceneMemory:
    angles = 2 * np.pi * np.arange(8 * STEPS) / STEPS
    angles += 0.02 * np.random.default_rng(0).standard_normal(len(angles))
    views = np.stack([view(angle, marked=marked) for angle in angles])
    return SceneMemory(image_codes(views), np.column_stack([np.cos(angles), np.sin(angles)]))


def turned(policy: LookRound, *, marked: bool, angle: float = 1.4) -> list[float]:
    """Turn as it commands, 0.15 rad for each turn, until it stops; give where it looked."""
    looked = []
    while True:
        looked.append(angle)
        command = policy({"view": view(angle, marked=marked)})
        if command is None:
            return looked
        angle -= command[1]


def test_it_turns_until_it_knows() -> None:
    policy = LookRound(memory(marked=True), TURN)
    looked = turned(policy, marked=True)
    assert policy.resolved_.all()
    assert policy.reasons_ == [""]
    assert 1 < len(looked) < 11


def test_it_says_that_nothing_tells() -> None:
    policy = LookRound(memory(marked=False), TURN)
    looked = turned(policy, marked=False)
    assert not policy.resolved_.any()
    assert "look alike" in policy.reasons_[0]
    assert len(looked) == 11
    # to one side, and to the other
    np.testing.assert_allclose([min(looked), max(looked)], [1.4 - 0.75, 1.4 + 0.75])


def test_explorers_are_a_batch() -> None:
    policy = LookRound(memory(marked=True), TURN)
    views = np.stack([view(angle, marked=True) for angle in (0.2, 1.4)])
    commands = policy({"view": views})
    assert commands is not None
    np.testing.assert_array_equal(commands[1], TURN)
    with pytest.raises(CogmapError, match="explorers"):
        policy({"view": views[:1]})
