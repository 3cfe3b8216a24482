import numpy as np
import pytest
import shapely

from arena.eye.capsules import paint

PLAN = np.full((40, 50, 3), 10.0)
STRIPS = np.stack([np.full((60, 3), 200.0), np.column_stack([np.linspace(0, 240, 60)] * 3)])


def painted(ends: list[list[float]], radius: float, strip: int = 0, texel: float = 1.0) -> np.ndarray:
    out = np.empty((1, *PLAN.shape), np.uint8)
    capsule = np.array(ends, float)[None, None]
    paint(capsule, np.array([radius]), STRIPS[strip : strip + 1], texel, PLAN, out)
    return out[0, :, :, 0]


@pytest.mark.parametrize(
    ("ends", "radius"),
    [([[10, -20], [40, -12]], 3.3), ([[25.3, -19.6], [25.3, -19.6]], 6.0), ([[-5, -5], [12, -45]], 4.0)],
)
def test_coverage_is_that_of_the_shape(ends: list[list[float]], radius: float) -> None:
    shape = shapely.LineString(ends).buffer(radius, quad_segs=64)
    if ends[0] == ends[1]:
        shape = shapely.Point(ends[0]).buffer(radius, quad_segs=64)
    x, y = np.meshgrid(np.arange(50), -np.arange(40))
    wanted = shapely.area(shapely.intersection(shape, shapely.box(x - 0.5, y - 0.5, x + 0.5, y + 0.5)))
    found = (painted(ends, radius) - 10.0) / 190
    # A straight edge aslant covers up to .1 less or more than the distance of a pixel's middle tells.
    assert np.abs(found - wanted).max() < 0.15
    assert found.sum() == pytest.approx(wanted.sum(), rel=0.01)


def test_colours_run_from_the_round_end_on() -> None:
    row = painted([[10, -20], [30, -20]], 3.0, strip=1, texel=0.5)[20]
    wanted = 240 / 59 * 2 * (np.arange(8, 32) - 7)
    np.testing.assert_allclose(row[8:32], wanted, atol=1)


def test_the_last_is_on_top_and_little_moves_change_little() -> None:
    ends = np.array([[[[10.0, -20.0], [30, -20]], [[20, -10], [20, -30]]]])
    out, moved = np.empty((1, *PLAN.shape), np.uint8), np.empty((1, *PLAN.shape), np.uint8)
    paint(ends, np.array([3.0, 3.0]), STRIPS[[0, 0]] * [[[1.0]], [[0.5]]], 1.0, PLAN, out)
    assert out[0, 20, 20, 0] == 100
    assert out[0, 20, 12, 0] == 200
    paint(ends + 0.01, np.array([3.0, 3.0]), STRIPS[[0, 0]] * [[[1.0]], [[0.5]]], 1.0, PLAN, moved)
    assert 0 < np.abs(moved.astype(int) - out).max() <= 3
