import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from arena.bodies.disc import Disc
from arena.motions.rotation import Rotation
from arena.rooms.arena import Arena
from cogmap.errors import CogmapError
from cogmap.plots.rooms.walk import plot_walk
from cogmap.plots.style import direction_colours


def lines(figure: Figure) -> list[LineCollection]:
    return [found for axes in figure.axes[:2] for found in axes.collections if type(found) is LineCollection]


@pytest.fixture
def room() -> Arena:
    return Arena.load("open_field")


def test_the_way_and_the_headings(room: Arena) -> None:
    rng = np.random.default_rng(0)
    times, poses = np.cumsum(rng.random(200)), rng.uniform([-2, -1.5, -3], [2, 1.5, 3], (200, 3))
    way, looks = lines(plot_walk(room, times, poses))
    np.testing.assert_array_equal(way.get_segments(), np.stack([poses[:-1, :2], poses[1:, :2]], axis=1))
    strokes = np.array(looks.get_segments())
    np.testing.assert_array_equal(strokes[:, 0], poses[:, :2])
    along = np.diff(strokes, axis=1)[:, 0]
    np.testing.assert_allclose(np.arctan2(along[:, 1], along[:, 0]), poses[:, 2])
    np.testing.assert_allclose(looks.get_color(), direction_colours(poses[:, 2]))
    colours = np.asarray(way.get_color())
    assert not np.array_equal(colours[0], colours[-1])


def test_axes_have_units_and_hold_the_room(room: Arena) -> None:
    figure = plot_walk(room, np.arange(5.0), np.zeros((5, 3)))
    rooms, bars = figure.axes[:2], figure.axes[2:]
    assert [(axes.get_xlabel(), axes.get_ylabel()) for axes in rooms] == [("x (m)", "y (m)")] * 2
    assert [axes.get_ylabel() for axes in bars] == ["time (s)", "heading (°)"]
    assert bars[0].get_ylim() == (0, 4)
    for axes in rooms:
        assert axes.get_xlim()[0] < -3 < 3 < axes.get_xlim()[1]


def test_of_many_views_some_are_drawn_and_it_says_so(room: Arena) -> None:
    walk = Rotation().walk(room, Disc(), None, np.random.default_rng(0))
    figure = plot_walk(room, walk.times, walk.poses)
    drawn = len(lines(figure)[1].get_segments())
    assert 1500 <= drawn <= 3000
    assert [axes.get_title() for axes in figure.axes[:2]] == [
        "open_field: the way of 5,000 views",
        f"where it looks in {drawn:,} of them",
    ]


def test_what_is_no_walk_is_refused(room: Arena) -> None:
    with pytest.raises(CogmapError, match="poses is not finite"):
        plot_walk(room, np.arange(5.0), np.full((5, 3), np.nan))
    with pytest.raises(CogmapError, match="times"):
        plot_walk(room, np.full(5, np.inf), np.zeros((5, 3)))
