"""Forgetting: errors in the first room while ever more others are learnt."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from cogmap.errors import CogmapError
from cogmap.plots.style import GOOD, SMALL, new_panels, tidy


def plot_forgetting(rooms: pd.DataFrame) -> Figure:
    """Draw errors and recognition in the first room over how many rooms are known.

    Parameters
    ----------
    rooms
        `rooms`, `heading_median_deg`, `position_median_m`, `recognised`, and `correlation` with the
        population vectors of the beginning; a row a room.

    Raises
    ------
    CogmapError
        Without a row.
    """
    if rooms.empty:
        raise CogmapError("no rooms to draw; give a table with at least one row")
    figure, panels = new_panels(10.5, 2.8, 1, 3)
    drawn = [
        ("heading_median_deg", "heading, median error (°)", 1.0),
        ("position_median_m", "position, median error (cm)", 100.0),
        ("correlation", "correlation, and share recognised", 1.0),
    ]
    for axes, (column, label, scale) in zip(panels, drawn, strict=True):
        tidy(axes, x="rooms known", y=label, size=SMALL)
        axes.plot(rooms["rooms"], scale * rooms[column], "o-", color=GOOD, markersize=4, linewidth=1)
        axes.set_ylim(bottom=0)
        axes.set_xticks(rooms["rooms"])
    panels[2].plot(rooms["rooms"], rooms["recognised"], "s--", color="0.5", markersize=3, linewidth=1)
    return figure
