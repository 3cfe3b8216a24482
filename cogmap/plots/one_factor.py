"""One factor at a time: what becomes of a map when one thing about the animal is varied, then another."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cogmap.errors import CogmapError
from cogmap.plots.style import BAD, GOOD, INK, SOFT, new_panels, tidy, tidy_legend

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


def plot_cases(cases: pd.DataFrame, labels: Mapping[str, str], *, doubling: bool = False) -> Figure:
    """Draw errors and cells along the one thing that was varied (above) and along the other (below).

    Hollow marks are maps that are not to be trusted.

    Parameters
    ----------
    cases
        The two columns varied, `trusted`, and the figures in `LINES`, a row a map; NaN is not drawn. Each row
        of panels takes the maps that share the other column with most.
    labels
        Of the two columns, by their names.
    doubling
        Whether equal steps are equal ratios.

    Raises
    ------
    CogmapError
        Unless two columns are labelled.
    """
    if len(labels) != 2:
        raise CogmapError(f"{len(labels)} columns are labelled; two are varied")
    figure, panels = new_panels(10.5, 5.6, 2, len(LINES))
    first, second = labels
    for row, along, other in zip(panels, (first, second), (second, first), strict=True):
        usual = cases[other].mode()[0]
        shown = cases[cases[other] == usual].sort_values(along)
        for axes, (name, lines) in zip(row, LINES.items(), strict=True):
            tidy(axes, x=labels[along], y=name, title=f"{labels[other]}: {usual:g}")
            if doubling:
                axes.set_xscale("log", base=2)
            _draw_lines(axes, shown, along, lines)
    return figure


def _draw_lines(axes: Axes, shown: pd.DataFrame, along: str, lines: dict[str, tuple[str, str, int]]) -> None:
    doubtful = shown[~shown["trusted"].astype(bool)]
    for key, (name, colour, factor) in lines.items():
        if key in shown:
            axes.plot(shown[along], factor * shown[key], "o-", color=colour, label=name, markersize=4)
            (hollow,) = axes.plot(doubtful[along], factor * doubtful[key], "o", color=colour, markersize=4)
            hollow.set_markerfacecolor("white")
    ticks = shown[along].tolist()
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.set_ylim(0, 1.08 * axes.get_ylim()[1])
    if axes.lines:
        tidy_legend(axes)
