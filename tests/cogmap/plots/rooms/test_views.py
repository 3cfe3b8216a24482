from collections.abc import Callable

import numpy as np
import pytest

from cogmap.errors import CogmapError
from cogmap.plots.rooms.views import plot_views

POSES = np.array([[1.0, -0.5, np.pi / 2], [0.25, 0.75, -np.pi / 4], [0, 0, 0], [1, 1, 1], [2, 1, 3]])


@pytest.fixture
def panoramas() -> np.ndarray:
    """The left half red, the right half blue, above the horizon; black below."""
    views = np.zeros((5, 60, 360, 3), np.uint8)
    views[:, :30, :180, 0] = 255
    views[:, :30, 180:, 2] = 255
    views[1] += 7
    return views


def test_every_view_is_drawn_as_it_is(panoramas: np.ndarray) -> None:
    panels = plot_views(panoramas, POSES).axes
    assert len(panels) == 6
    for axes, view in zip(panels[:5], panoramas, strict=True):
        np.testing.assert_array_equal(axes.images[0].get_array(), view)
    assert not panels[5].images
    assert not panels[5].axison


def test_titles_are_poses_in_metres_and_degrees(panoramas: np.ndarray) -> None:
    panels = plot_views(panoramas, POSES).axes
    assert panels[0].get_title() == "x 1.00 m, y −0.50 m, heading 90°"
    assert panels[1].get_title() == "x 0.25 m, y 0.75 m, heading −45°"
    assert plot_views(panoramas).axes[0].get_title() == ""


def test_left_of_a_panorama_is_positive_azimuth(panoramas: np.ndarray, pixel: Callable) -> None:
    figure = plot_views(panoramas, columns=2)
    axes = figure.axes[0]
    assert axes.get_xlim() == (180, -180)
    np.testing.assert_array_equal(axes.get_xticks(), [-180, -90, 0, 90, 180])
    np.testing.assert_array_equal(pixel(figure, axes, (90, 15)), [1, 0, 0])
    np.testing.assert_array_equal(pixel(figure, axes, (-90, 15)), [0, 0, 1])
    np.testing.assert_array_equal(pixel(figure, axes, (90, -15)), [0, 0, 0])
    assert figure.get_supxlabel() == "azimuth (°)"
    assert figure.get_supylabel() == "elevation (°)"


def test_elevation_is_that_of_a_cylinder_with_square_pixels(panoramas: np.ndarray) -> None:
    axes = plot_views(panoramas).axes[0]
    focal = 360 / (2 * np.pi)
    rows_above = np.array(axes.get_yticks()) / (2 * axes.images[0].get_extent()[3]) * 60
    names = [float(tick.get_text().replace("−", "-")) for tick in axes.get_yticklabels()]
    assert names == [-20, 0, 20]
    np.testing.assert_allclose(np.rad2deg(np.arctan(rows_above / focal)), names)
    assert axes.get_aspect() == 1


def test_perspective_views_count_pixels() -> None:
    views = np.random.default_rng(0).integers(0, 255, (2, 24, 32, 3), dtype=np.uint8)
    figure = plot_views(views, panoramic=False)
    assert len(figure.axes) == 2
    assert figure.get_supxlabel() == "column (pixels)"
    assert figure.get_supylabel() == "row (pixels)"
    assert figure.axes[0].get_xlim() == (-0.5, 31.5)
    assert figure.axes[0].get_ylim() == (23.5, -0.5)


def test_bad_input_is_refused(panoramas: np.ndarray) -> None:
    with pytest.raises(CogmapError, match="0 views"):
        plot_views(panoramas[:0])
    with pytest.raises(CogmapError, match="in 0 columns"):
        plot_views(panoramas, columns=0)
    with pytest.raises(CogmapError, match="poses is not finite"):
        plot_views(panoramas, np.full((5, 3), np.inf))
