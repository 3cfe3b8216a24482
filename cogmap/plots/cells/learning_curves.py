"""Learning curves: what both populations are worth while they learn, and while charts fall silent."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from cogmap.errors import CogmapError
from cogmap.plots.style import BAD, GOOD, SOFT, new_panels, tidy, tidy_legend

PANELS = {
    "passing, covered (share)": {
        "place_cells_passing": ("place cells", GOOD, "-"),
        "heading_cells_passing": ("heading cells", BAD, "-"),
        "place_coverage": ("area in a place field", SOFT, "--"),
    },
    "median error of position (m)": {"position_median_m": ("read from place cells", GOOD, "-")},
    "median error of heading (°)": {"heading_median_deg": ("read from heading cells", BAD, "-")},
}


def plot_courses(growth: pd.DataFrame, silencing: pd.DataFrame) -> Figure:
    """Draw passing cells and errors against the views seen (above) and the charts silenced (below).

    Parameters
    ----------
    growth, silencing
        Rows of `views` and of `silent` (share of charts), each with `place_cells_passing`,
        `heading_cells_passing`, `place_coverage`, `position_median_m` and `heading_median_deg`.

    Raises
    ------
    CogmapError
        Without a row.
    """
    if growth.empty or silencing.empty:
        raise CogmapError(f"{len(growth)} and {len(silencing)} rows; give at least one of each")
    figure, panels = new_panels(11.0, 5.6, 2, len(PANELS))
    lines = ((growth, "views", "views seen"), (silencing, "silent", "charts silenced (share)"))
    for line, (rows, along, name) in zip(panels, lines, strict=True):
        for axes, (label, curves) in zip(line, PANELS.items(), strict=True):
            tidy(axes, x=name, y=label)
            for column, (curve, colour, style) in curves.items():
                points = rows[along], rows[column]
                axes.plot(*points, style, color=colour, marker="o", markersize=3, label=curve)
            highest = max(float(rows[list(curves)].max().max()), 1e-9)
            axes.set_ylim(0, 1.05 if label.endswith("(share)") else 1.1 * highest)
            if rows is growth:
                axes.set_xscale("log")
            tidy_legend(axes)
    return figure
