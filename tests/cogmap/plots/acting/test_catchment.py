import numpy as np

from arena import Arena
from cogmap.plots import plot_catchment
from cogmap.plots.acting.catchment import Field


def test_fields_are_drawn_where_they_lie_and_what_is_not_caught_is_crossed() -> None:
    difference = np.array([[1.0, 2.0, np.nan], [3.0, 4.0, 5.0]])
    caught = np.array([[True, True, False], [True, False, True]])
    ended = np.array([[0.01, 0.02, np.nan], [0.03, 0.9, 0.04]])
    goal = np.array([-1.9, -1.4, 0.0])
    field = Field(goal, (-2.0, -1.5), 0.2, difference, caught, ended)
    figure = plot_catchment(Arena.load("furnished"), [field, field])
    above, below = figure.axes[0], figure.axes[2]
    np.testing.assert_array_equal(above.images[0].get_array().filled(np.nan), difference)
    np.testing.assert_allclose(above.images[0].get_extent(), [-2.0, -1.4, -1.5, -1.1])
    np.testing.assert_allclose(below.images[0].get_array().filled(np.nan), 100 * ended)
    crosses = next(line for line in above.lines if line.get_marker() == "x")
    np.testing.assert_allclose(crosses.get_xydata(), [[-1.7, -1.2]])
    assert "80%" in above.get_title()
    assert "80%" in below.get_title()
