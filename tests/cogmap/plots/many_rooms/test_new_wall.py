import numpy as np
import pandas as pd
import pytest

from arena import Arena
from cogmap.cells import RateMaps, bin_edges, rate_maps
from cogmap.errors import CogmapError
from cogmap.experiments.rooms.new_wall import with_a_wall
from cogmap.plots import plot_new_wall


def maps(seed: int) -> RateMaps:
    rng = np.random.default_rng(seed)
    xy = rng.uniform(-1, 1, (500, 2))
    return rate_maps(rng.random((500, 9)), xy, edges=bin_edges(np.array([(-1.0, -1), (1, 1)])))


def test_cells_that_change_most_beside_the_wall_and_the_course_of_errors() -> None:
    rounds = pd.DataFrame(
        {"views": [0, 100], "heading_over_alone": [3.0, 1.1], "position_over_alone": [2.0, 1.0]}
    )
    room = with_a_wall(Arena.load("open_field"))
    figure = plot_new_wall(room, maps(0), maps(1), maps(2), rounds)
    above, below = figure.subfigs
    drawn = [len(axes.patches) for axes in above.axes if axes.collections]
    assert drawn[:18].count(1) == 12  # the wall, but not before it stood
    heading = next(line for line in below.axes[0].lines if line.get_label() == "heading")
    np.testing.assert_allclose(heading.get_ydata(), [3.0, 1.1])


def test_an_empty_table_is_refused() -> None:
    with pytest.raises(CogmapError, match="no rounds to draw"):
        plot_new_wall(Arena.load("open_field"), maps(0), maps(1), maps(2), pd.DataFrame({"views": []}))
