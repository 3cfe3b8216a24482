import numpy as np

from arena.angles import wrap_angle
from cogmap.coordinates.relaxation import read_between, relaxed


def cylinder(points: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    phase, height = rng.uniform(-np.pi, np.pi, points), rng.uniform(-1, 1, points)
    return np.column_stack([np.cos(phase), np.sin(phase), height]), phase[:, None], height[:, None]


def test_noise_averages_out() -> None:
    codes, phases, heights = cylinder(1500, 0)
    rng = np.random.default_rng(1)
    noisy = wrap_angle(phases + rng.normal(scale=0.1, size=phases.shape))
    turned, raised = relaxed(codes, noisy, heights + rng.normal(scale=0.1, size=heights.shape))
    assert np.abs(wrap_angle(turned - phases)).mean() < 0.05
    assert np.abs(raised - heights).mean() < 0.05
    assert (np.abs(turned) <= np.pi).all()


def test_what_is_smooth_stays() -> None:
    codes, phases, heights = cylinder(1500, 2)
    turned, raised = relaxed(codes, phases, heights)
    assert np.median(np.abs(wrap_angle(turned - phases))) < 0.003
    assert np.median(np.abs(raised - heights)) < 0.003


def test_others_are_read_between() -> None:
    codes, phases, heights = cylinder(1500, 3)
    queries, truth, levels = cylinder(200, 4)
    turned, raised = read_between(codes, phases, heights, queries)
    assert np.median(np.abs(wrap_angle(turned - truth))) < 0.003
    assert np.median(np.abs(raised - levels)) < 0.003
