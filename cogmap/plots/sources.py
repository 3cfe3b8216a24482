"""What becomes of a map with fewer odours or a worse nose."""

from __future__ import annotations

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cogmap.plots.style import BAD, GOOD, INK, SOFT, new_figure, tidy, tidy_legend

LINES = {
    "position error (cm), median": {
        "position_median_m": ("recalled odour", GOOD, 100),
        "place_position_median_m": ("place cells", INK, 100),
        "nose_position_median_m": ("raw nose", BAD, 100),
    },
    "heading error (°), median": {"heading_median_deg": ("recalled phase", GOOD, 1)},
    "share of cells": {
        "place_cells_passing": ("place cells", GOOD, 1),
        "heading_cells_passing": ("heading cells", BAD, 1),
        "single_field": ("a single field", SOFT, 1),
    },
}
"""By panel: which figures, their name, colour and factor."""


def plot_sources(cases: pd.DataFrame) -> Figure:
    """Draw errors and cells by number of sources (above) and by noise (below).

    Parameters
    ----------
    cases
        `sources`, `noise` and the figures in `LINES`, a row a map; NaN is not drawn. Each row of panels takes
        the maps that share the other setting with most.
    """
    figure = new_figure(10.5, 5.6)
    panels = figure.subplots(2, len(LINES), squeeze=False)
    settings = {"sources": ("noise", "odour sources"), "noise": ("sources", "noise of the nose")}
    for row, (along, (other, label)) in zip(panels, settings.items(), strict=True):
        usual = cases[other].mode()[0]
        shown = cases[cases[other] == usual].sort_values(along)
        for axes, (name, lines) in zip(row, LINES.items(), strict=True):
            tidy(axes, x=label, y=name, title=f"{other}: {usual:g}")
            _draw_lines(axes, shown, along, lines)
    return figure


def _draw_lines(axes: Axes, shown: pd.DataFrame, along: str, lines: dict[str, tuple[str, str, int]]) -> None:
    for key, (name, colour, factor) in lines.items():
        if key in shown:
            axes.plot(shown[along], factor * shown[key], "o-", color=colour, label=name, markersize=4)
    axes.set_xticks(shown[along].tolist())
    axes.set_ylim(0, 1.08 * axes.get_ylim()[1])
    if axes.lines:
        tidy_legend(axes)
