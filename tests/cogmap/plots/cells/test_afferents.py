import numpy as np
import pytest
from matplotlib.collections import PathCollection

from cogmap.errors import CogmapError
from cogmap.plots.cells.afferents import plot_afferents

RNG = np.random.default_rng(0)
PREFERRED = np.column_stack([RNG.uniform(-1, 1, (40, 2)), RNG.uniform(-np.pi, np.pi, 40)])
PLACE, HEADING = RNG.uniform(0, 8, (40, 20)), RNG.uniform(0, 12, (40, 10))


def dots(axes: object) -> PathCollection:
    (found,) = axes.collections  # type: ignore[attr-defined]
    return found


def test_place_weights_lie_where_the_charts_do_strongest_on_top() -> None:
    axes = plot_afferents(PLACE, HEADING, PREFERRED).axes
    for panel, cell in zip(axes[:5], (0, 4, 8, 12, 16), strict=True):
        assert panel.get_title() == f"place cell {cell}"
        order = np.argsort(PLACE[:, cell])
        np.testing.assert_allclose(dots(panel).get_offsets(), PREFERRED[order, :2])
        np.testing.assert_allclose(dots(panel).get_array(), PLACE[order, cell])
        assert dots(panel).get_clim() == (0, PLACE.max())
        assert panel.get_xlabel() == "x (m)"


def test_heading_weights_stand_over_headings() -> None:
    axes = plot_afferents(PLACE, HEADING, PREFERRED).axes
    for panel, cell in zip(axes[5:10], (0, 2, 4, 6, 8), strict=True):
        assert panel.get_title() == f"head-direction cell {cell}"
        np.testing.assert_allclose(
            dots(panel).get_offsets(), np.column_stack([np.rad2deg(PREFERRED[:, 2]), HEADING[:, cell]])
        )
        assert panel.get_ylabel() == "weight (Hz)"
        assert panel.get_ylim()[1] > HEADING.max()


def test_few_or_silent_cells_are_drawn_too() -> None:
    figure = plot_afferents(np.zeros((40, 2)), np.zeros((40, 1)), PREFERRED)
    assert sum(bool(axes.collections) for axes in figure.axes[:10]) == 3
    titles = [axes.get_title() for axes in plot_afferents(PLACE, HEADING, PREFERRED, count=2).axes[:2]]
    assert titles == ["place cell 0", "place cell 10"]


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(CogmapError, match=r"preferred has shape \(0, 3\)"):
        plot_afferents(PLACE[:0], HEADING[:0], PREFERRED[:0])
    with pytest.raises(CogmapError, match="heading is not finite"):
        plot_afferents(PLACE, HEADING * np.nan, PREFERRED)
