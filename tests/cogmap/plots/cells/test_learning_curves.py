import numpy as np
import pandas as pd
import pytest

from cogmap.errors import CogmapError
from cogmap.plots.cells.learning_curves import PANELS, plot_courses

FIGURES = {
    "place_cells_passing": [0.1, 0.5, 0.9],
    "heading_cells_passing": [0.0, 0.9, 1.0],
    "place_coverage": [0.2, 0.6, 1.0],
    "position_median_m": [0.8, 0.2, 0.05],
    "heading_median_deg": [60.0, 9.0, 3.0],
}
GROWTH = pd.DataFrame({"views": [30, 300, 3000], **FIGURES})
SILENCING = pd.DataFrame({"silent": [0.0, 0.2, 0.5], **{name: v[::-1] for name, v in FIGURES.items()}})


def test_every_column_is_a_curve_against_views_above_and_silence_below() -> None:
    axes = plot_courses({"with sight": GROWTH, "by smell": GROWTH}, SILENCING).axes
    lines = ((axes[:3], GROWTH, "views"), (axes[3:6], GROWTH, "views"), (axes[6:], SILENCING, "silent"))
    for line, rows, along in lines:
        for panel, (label, curves) in zip(line, PANELS.items(), strict=True):
            assert panel.get_ylabel() == label
            assert len(panel.lines) == len(curves)
            for curve, (column, (told, colour, style)) in zip(panel.lines, curves.items(), strict=True):
                np.testing.assert_array_equal(curve.get_xdata(), rows[along])
                np.testing.assert_array_equal(curve.get_ydata(), rows[column])
                assert (curve.get_label(), curve.get_color(), curve.get_linestyle()) == (told, colour, style)
                assert panel.get_ylim()[0] == 0
                assert panel.get_ylim()[1] > rows[column].max()


def test_views_are_on_a_logarithmic_axis_and_shares_are_not() -> None:
    axes = plot_courses({"with sight": GROWTH, "by smell": GROWTH}, SILENCING).axes
    assert [axes[line].get_title() for line in (0, 3, 6)] == ["with sight", "by smell", "charts fall silent"]
    assert [panel.get_xscale() for panel in axes] == ["log"] * 6 + ["linear"] * 3
    assert [panel.get_xlabel() for panel in axes] == ["views met"] * 6 + ["charts silenced (share)"] * 3


def test_nothing_to_draw_is_refused() -> None:
    with pytest.raises(CogmapError, match="3, 0\\] rows"):
        plot_courses({"with sight": GROWTH}, SILENCING.iloc[:0])
