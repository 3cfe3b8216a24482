"""Morph: what cells follow in blends of two rooms."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from cogmap.errors import CogmapError
from cogmap.plots.style import BAD, GOOD, INK, SMALL, SOFT, new_panels, tidy, tidy_legend


def plot_morph(curves: pd.DataFrame) -> Figure:
    """Draw curves over the blend, a thin line a seed and a thick one their mean.

    Parameters
    ----------
    curves
        `seed`, `blend` (0 to 1), `place` and `heading` (−1 to 1), `room`, `nowhere` and `confidence`
        (0 to 1), a row a blend and seed.

    Raises
    ------
    CogmapError
        Without a row.
    """
    if curves.empty:
        raise CogmapError("no blends to draw; give a table with at least one row")
    figure, (left, right) = new_panels(9.6, 3.4, 1, 2)
    tidy(left, x="share of the second room", y="follows the first (−1) or the second (1)", size=SMALL)
    tidy(right, x="share of the second room", y="share of views, or confidence", size=SMALL)
    left.axhline(0, color=SOFT, linewidth=0.8)
    drawn = [
        (left, "place", GOOD, "place cells"),
        (left, "heading", BAD, "heading cells"),
        (right, "room", GOOD, "taken for the second room"),
        (right, "nowhere", SOFT, "taken for neither"),
        (right, "confidence", INK, "confidence"),
    ]
    for axes, column, colour, label in drawn:
        for _, each in curves.groupby("seed"):
            axes.plot(each["blend"], each[column], color=colour, linewidth=0.6, alpha=0.6)
        mean = curves.groupby("blend")[column].mean()
        axes.plot(mean.index, mean, "o-", color=colour, linewidth=1.8, markersize=3.5, label=label)
    left.set_ylim(-1.05, 1.05)
    right.set_ylim(-0.03, 1.05)
    for axes in (left, right):
        tidy_legend(axes)
    return figure
