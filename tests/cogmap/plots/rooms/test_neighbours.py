from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.colors import same_color

from cogmap import CogmapError
from cogmap.plots import plot_neighbours
from cogmap.plots.style import BAD, INK

RNG = np.random.default_rng(0)
QUERIES = RNG.integers(0, 255, (2, 6, 8, 3), dtype=np.uint8)
NEIGHBOURS = RNG.integers(0, 255, (2, 3, 6, 8, 3), dtype=np.uint8)
POSES = np.array([[1.0, -0.5, np.pi / 2], [0.25, 0.75, -np.pi / 4]])
NEAR = POSES[:, None] + np.array([[0.1, 0, 0], [0.2, 0, 0], [0, 0.3, np.pi / 6]])


def test_every_query_stands_before_its_neighbours() -> None:
    panels = np.array(plot_neighbours(QUERIES, POSES, NEIGHBOURS, NEAR).axes).reshape(2, 4)
    for row, query, near in zip(panels, QUERIES, NEIGHBOURS, strict=True):
        np.testing.assert_array_equal([axes.images[0].get_array() for axes in row], [query, *near])


def test_titles_are_ranks_and_poses_in_metres_and_degrees() -> None:
    panels = plot_neighbours(QUERIES, POSES, NEIGHBOURS, NEAR).axes
    assert [axes.get_title() for axes in panels[:4]] == [
        "query\n1.00 m, −0.50 m, 90°",
        "neighbour 1\n1.10 m, −0.50 m, 90°",
        "neighbour 2\n1.20 m, −0.50 m, 90°",
        "neighbour 3\n1.00 m, −0.20 m, 120°",
    ]
    assert panels[4].get_title() == "query\n0.25 m, 0.75 m, −45°"
    assert [same_color(axes.title.get_color(), BAD) for axes in panels] == 2 * [True, False, False, False]
    assert same_color(panels[1].title.get_color(), INK)


def test_pixels_are_not_blended(pixel: Callable) -> None:
    queries, neighbours = np.zeros((1, 4, 4, 3), np.uint8), np.zeros((1, 1, 4, 4, 3), np.uint8)
    neighbours[0, 0, 0, 3] = 255
    figure = plot_neighbours(queries, POSES[:1], neighbours, NEAR[:1, :1])
    near = figure.axes[1]
    np.testing.assert_array_equal(pixel(figure, near, (2.6, 0.4)), [1, 1, 1])
    np.testing.assert_array_equal(pixel(figure, near, (2.4, 0)), [0, 0, 0])
    np.testing.assert_array_equal(pixel(figure, near, (3, 0.6)), [0, 0, 0])


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(CogmapError, match=r"2 queries have \(2, 0\) neighbours"):
        plot_neighbours(QUERIES, POSES, NEIGHBOURS[:, :0], NEAR[:, :0])
    with pytest.raises(CogmapError, match="0 queries have"):
        plot_neighbours(QUERIES[:0], POSES[:0], NEIGHBOURS[:0], NEAR[:0])
    with pytest.raises(CogmapError, match="poses is not finite"):
        plot_neighbours(QUERIES, POSES * np.nan, NEIGHBOURS, NEAR)
    with pytest.raises(CogmapError, match="near is not finite"):
        plot_neighbours(QUERIES, POSES, NEIGHBOURS, NEAR * np.inf)
