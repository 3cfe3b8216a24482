import numpy as np
import pytest

from arena import Axis
from cogmap.errors import CogmapError
from cogmap.plots.bodies.coordinates import plot_coordinates

HINGE = Axis("hinge", "line", "rad", (-1.0, 1.0))
CIRCLE, LINE = Axis("shoulder", "circle", "rad"), Axis("carriage", "line", "m", (0.0, 2.0))


def test_views_lie_where_their_coordinates_are() -> None:
    at = np.array([[-2.5, -1.0], [2.5, 1.0]])
    views = np.stack([np.full((6, 6, 3), grey, np.uint8) for grey in (10, 240)])
    joints = np.array([[1.0, 0.5], [2.0, 1.5]])
    figure = plot_coordinates(at, ["phase_0", "height_0"], views, joints, [CIRCLE, LINE])
    seen, shoulder, carriage, *_ = figure.axes
    for image in seen.images:
        left, right, low, high = image.get_extent()
        middle = np.array([left + right, low + high]) / 2
        nearest = np.argmin(np.linalg.norm((at - middle) / [2 * np.pi, 2.1], axis=1))
        np.testing.assert_array_equal(image.get_array(), views[nearest])
    assert len(seen.images) >= 2
    assert seen.get_xlabel() == "phase_0 (°)"
    assert seen.get_ylabel() == "height_0"
    np.testing.assert_array_equal(carriage.collections[0].get_array(), joints[:, 1])
    np.testing.assert_allclose(np.asarray(shoulder.collections[0].get_offsets()), at)


def test_one_coordinate_is_drawn_over_the_joint() -> None:
    views = np.zeros((3, 4, 12, 3), np.uint8)
    figure = plot_coordinates(
        np.array([[0.1], [0.2], [0.3]]), ["phase_0"], views, np.array([[1.0], [1.5], [2.0]]), [CIRCLE]
    )
    assert figure.axes[1].get_ylabel() == "shoulder (°)"
    np.testing.assert_allclose(figure.axes[1].collections[0].get_offsets()[:, 1], np.rad2deg([1, 1.5, 2]))


def test_a_hinge_is_coloured_in_degrees() -> None:
    views, joints = np.zeros((2, 4, 4, 3), np.uint8), np.array([[-1.0], [0.5]])
    dots = plot_coordinates(joints @ [[1.0, 2.0]], ["height_0", "height_1"], views, joints, [HINGE]).axes[1]
    assert dots.collections[0].get_clim() == pytest.approx((np.rad2deg(-1), np.rad2deg(0.5)))


def test_names_that_do_not_fit() -> None:
    with pytest.raises(CogmapError, match="1 coordinates but 2 names"):
        plot_coordinates(
            np.zeros((2, 1)), ["a", "b"], np.zeros((2, 4, 4, 3), np.uint8), np.zeros((2, 1)), [LINE]
        )
