import numpy as np

from cogmap.evaluation.angle_cells import share_of_one_angle

ANGLES = np.random.default_rng(0).uniform(-np.pi, np.pi, size=(4000, 2))


def test_a_phase_of_one_angle_passes_and_of_both_does_not() -> None:
    own, other = ANGLES.T
    assert share_of_one_angle(own + 0.3 * np.sin(own), own, other) == 1
    assert share_of_one_angle(own + other, own, other) == 0
    assert share_of_one_angle(np.where(own > 0, own, other), own, other) < 1
    assert share_of_one_angle(own, own, own) == 0
