import numpy as np
import pandas as pd

from cogmap.plots import plot_reached


def test_steps_are_the_shares_of_journeys_within_each_error() -> None:
    sizes = np.array([0.04, 0.01, 0.02, 0.03])
    tables = {
        name: pd.DataFrame({"position_error_m": scale * sizes, "heading_error_deg": 10 * sizes})
        for name, scale in (("in peace", 1), ("true", 0.5))
    }
    left, right = plot_reached(tables).axes
    for axes, first in ((left, [1, 2, 3, 4]), (right, [0.1, 0.2, 0.3, 0.4])):
        curves = {each.get_label(): each for each in axes.lines if not each.get_label().startswith("_")}
        assert list(curves) == ["in peace", "true"]
        np.testing.assert_allclose(curves["in peace"].get_xdata(), first)
        np.testing.assert_allclose(curves["in peace"].get_ydata(), [25, 50, 75, 100])
        assert curves["in peace"].get_linewidth() > curves["true"].get_linewidth()
        assert curves["true"].get_linestyle() == "--"
    np.testing.assert_allclose(left.lines[-1].get_xdata(), [0.5, 1, 1.5, 2])
    assert left.get_xlabel() == "distance from the goal (cm)"
