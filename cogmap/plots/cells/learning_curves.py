"""Learning curves: what both populations are worth while they learn, and while charts fall silent."""

from __future__ import annotations

from collections.abc import Mapping

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


def plot_courses(growth: Mapping[str, pd.DataFrame], silencing: pd.DataFrame) -> Figure:
    """Draw passing cells and errors against the views met, a line of panels a course, and charts silenced.

    Parameters
    ----------
    growth
        Rows of `views`, by the name of the course.
    silencing
        Rows of `silent` (share of charts), drawn below; all have `place_cells_passing`,
        `heading_cells_passing`, `place_coverage`, `position_median_m` and `heading_median_deg`.

    Raises
    ------
    CogmapError
        Without a row.
    """
    courses = {**growth, "charts fall silent": silencing}
    if any(rows.empty for rows in courses.values()):
        raise CogmapError(f"{[len(rows) for rows in courses.values()]} rows; give at least one of each")
    figure, panels = new_panels(11.0, 2.8 * len(courses), len(courses), len(PANELS))
    for line, (name, rows) in zip(panels, courses.items(), strict=True):
        along, told = ("silent", "charts silenced (share)") if rows is silencing else ("views", "views met")
        for axes, (label, curves) in zip(line, PANELS.items(), strict=True):
            tidy(axes, x=told, y=label, title=name if axes is line[0] else "")
            for column, (curve, colour, style) in curves.items():
                points = rows[along], rows[column]
                axes.plot(*points, style, color=colour, marker="o", markersize=3, label=curve)
            highest = max(float(rows[list(curves)].max().max()), 1e-9)
            axes.set_ylim(0, 1.05 if label.endswith("(share)") else 1.1 * highest)
            if along == "views":
                axes.set_xscale("log")
            tidy_legend(axes)
    return figure
