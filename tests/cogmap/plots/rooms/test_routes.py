import numpy as np
import pytest
import shapely
from matplotlib.axes import Axes
from matplotlib.colors import same_color
from matplotlib.figure import Figure

from arena import Arena, Disc
from cogmap import CogmapError
from cogmap.plots import plot_routes
from cogmap.plots.style import GOOD

ROOM = Arena.load("obstacles")
MINE = np.array([[-1.5, -1, 0.5], [-1, -1.1, 1.0], [0, -1.2, 2.0], [1.2, -1, 3.0]])
THEIRS = np.array([[-1.5, -1, 0.5], [1.2, -1, 3.0]])


def drawn(axes: Axes, label: str) -> np.ndarray:
    return next(line.get_xydata() for line in axes.lines if line.get_label() == label)


def legend(figure: Figure) -> set[str]:
    return {text.get_text() for text in figure.legends[0].get_texts()}


def test_paths_and_their_ends_are_those_given() -> None:
    axes = plot_routes(ROOM, [(MINE, THEIRS)]).axes[0]
    np.testing.assert_array_equal(drawn(axes, "visual roadmap"), MINE[:, :2])
    np.testing.assert_array_equal(drawn(axes, "OMPL's PRM"), THEIRS[:, :2])
    np.testing.assert_array_equal(drawn(axes, "start"), MINE[:1, :2])
    np.testing.assert_array_equal(drawn(axes, "goal"), MINE[-1:, :2])
    assert axes.get_title() == "2 views on the way"


def test_arrows_point_where_the_body_looks() -> None:
    arrows = plot_routes(ROOM, [(MINE, None)]).axes[0].collections[-1]
    np.testing.assert_array_equal(arrows.get_offsets(), MINE[:, :2])
    np.testing.assert_allclose(arrows.U, 0.2 * np.cos(MINE[:, 2]))
    np.testing.assert_allclose(arrows.V, 0.2 * np.sin(MINE[:, 2]))


def test_the_band_is_what_the_body_sweeps() -> None:
    axes = plot_routes(ROOM, [(MINE, None)]).axes[0]
    bands = [patch for patch in axes.patches if same_color(patch.get_facecolor()[:3], GOOD)]
    band = shapely.Polygon(bands[0].get_xy())
    assert len(bands) == 1
    path = shapely.LineString(MINE[:, :2])
    assert band.area == pytest.approx(path.buffer(Disc().radius).area)
    assert band.boundary.distance(path) == pytest.approx(Disc().radius, rel=0.01)


def test_axes_are_metres_and_hold_the_platform() -> None:
    axes = plot_routes(ROOM, [(MINE, None)]).axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (m)", "y (m)")
    assert axes.get_aspect() == 1
    x0, y0, x1, y1 = ROOM.walkable.bounds
    assert axes.get_xlim()[0] < x0 < x1 < axes.get_xlim()[1]
    assert axes.get_ylim()[0] < y0 < y1 < axes.get_ylim()[1]


def test_four_routes_take_two_rows_and_one_legend() -> None:
    figure = plot_routes(ROOM, [(MINE, None), (MINE, THEIRS), (MINE, None), (MINE[:3], None)])
    panels = figure.axes
    assert len(panels) == 6
    assert [axes.axison for axes in panels] == 4 * [True] + 2 * [False]
    assert panels[3].get_title() == "1 views on the way"
    assert legend(figure) == {"visual roadmap", "OMPL's PRM", "start", "goal"}


def test_without_a_peer_it_has_no_name_and_a_floor_neither() -> None:
    floored = ROOM.model_copy(update={"floor": "oak"})
    assert legend(plot_routes(floored, [(MINE, None)])) == {"visual roadmap", "start", "goal"}


def test_no_routes_are_an_empty_sheet_and_nonsense_is_refused(tmp_path) -> None:
    figure = plot_routes(ROOM, [])
    assert not figure.legends
    figure.savefig(tmp_path / "nothing.png")
    with pytest.raises(CogmapError, match="route is not finite"):
        plot_routes(ROOM, [(MINE * np.nan, None)])
    with pytest.raises(CogmapError, match="route is not finite"):
        plot_routes(ROOM, [(MINE, THEIRS * np.inf)])
