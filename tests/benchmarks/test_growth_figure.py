import numpy as np
import pytest

from benchmarks.growth_figure import plot_growth
from benchmarks.scaling import growth


def test_panel_shows_what_was_measured_and_its_law() -> None:
    found = growth((1, 10, 100, 1000), lambda size: 2e-3 * size**0.5)
    figure = plot_growth({"eating_by_leaves": found, "load_before": 1.0})
    axes, *empty = figure.axes
    assert [panel.axison for panel in empty] == [False] * 3
    assert axes.get_title() == "eating, exponent 0.50 ± 0.00"
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("leaves", "time (ms)")
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    for line in axes.lines:
        assert np.asarray(line.get_xdata()).tolist() == [1, 10, 100, 1000]
        assert np.asarray(line.get_ydata()) == pytest.approx([2, 2 * 10**0.5, 20, 20 * 10**0.5])
    low, high = axes.get_ylim()
    assert low < 2
    assert high > 20 * 10**0.5


def test_what_does_not_grow_is_drawn_over_a_factor_of_ten() -> None:
    figure = plot_growth({"eating_by_leaves": growth((1, 10, 100), lambda size: 1 + size / 1e4)})
    low, high = figure.axes[0].get_ylim()
    assert high / low == pytest.approx(10)
