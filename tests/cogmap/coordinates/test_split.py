import numpy as np
import pytest

from arena.angles import wrap_angle
from cogmap.coordinates.split import split_torus
from cogmap.errors import CogmapError

RNG = np.random.default_rng(0)
JOINTS = RNG.uniform(-np.pi, np.pi, size=(1500, 2))
CODES = np.hstack([np.cos(JOINTS), np.sin(JOINTS)])
PHASES = wrap_angle(JOINTS @ np.array([[1, 1], [1, 0]]) + 0.2 * np.sin(JOINTS))


def tilt(joint: int) -> np.ndarray:
    angle = JOINTS[:, joint]
    return np.column_stack([np.cos(angle), np.sin(angle)]) + 0.1 * RNG.standard_normal((1500, 2))


@pytest.mark.parametrize("joint", [0, 1])
def test_what_one_joint_feels(joint: int) -> None:
    found = split_torus(CODES, PHASES, tilt(joint))
    assert found.rank == 1
    for phase, true in ((found.felt, JOINTS[:, joint]), (found.unfelt, JOINTS[:, 1 - joint])):
        assert max(abs(np.exp(1j * (phase - sign * true)).mean()) for sign in (-1, 1)) > 0.9


def test_controls() -> None:
    assert split_torus(CODES, PHASES, RNG.normal(size=(1500, 2))).rank == 0
    both = split_torus(CODES, PHASES, np.hstack([tilt(0), tilt(1)]))
    assert (both.rank, both.felt, both.unfelt) == (2, None, None)


def test_one_phase_does_not_split() -> None:
    with pytest.raises(CogmapError, match="1 phases"):
        split_torus(CODES, PHASES[:, :1], tilt(0))
