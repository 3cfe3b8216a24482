"""Cue control: what each cell follows when what is seen turns and what is smelt stays."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from cogmap.errors import CogmapError
from cogmap.plots.style import ABSENT, BAD, GOOD, QUARTERS, SMALL, SOFT, new_panels, tidy


def plot_cue_control(place: pd.DataFrame, heading: pd.DataFrame) -> Figure:
    """Draw what place cells follow, a panel by what is sensed, and how far heading cells turn; a line a room.

    A dot is a place cell: blue above the dashed line, where its map is more like the first one turned with
    what is seen, red below it, where it is more like the first one as it was. On the right is how many
    head-direction cells have turned by how much: blue by what is sensed first in the table, red by the next.

    Parameters
    ----------
    place
        `arena`, `sensed`, and the correlations `sight` and `smells`, a row a cell.
    heading
        `arena`, `sensed` and `shift_deg`, a row a cell; cells that are silent, of NaN, are not drawn.

    Raises
    ------
    CogmapError
        Without a cell.
    """
    if place.empty:
        raise CogmapError("no place cells to draw; give a table with at least one")
    rooms, senses = place["arena"].unique(), place["sensed"].unique()
    side = 2.3  # inches
    size = side * (len(senses) + 1) + 0.6, side * len(rooms) + 0.5
    figure, panels = new_panels(*size, len(rooms), len(senses) + 1, squeeze=False)
    for line, room in zip(panels, rooms, strict=True):
        for axes, sensed in zip(line, senses, strict=False):
            mine = place[(place["arena"] == room) & (place["sensed"] == sensed)]
            follows = mine["sight"] > mine["smells"]
            tidy(
                axes,
                x="r with the map as it was",
                y=f"{room}\nr with the map turned" if axes is line[0] else "",
                title=f"{sensed}: {follows.mean():.0%} turn",
                size=SMALL,
            )
            axes.plot([-1, 1], [-1, 1], "--", color=SOFT, linewidth=0.8)
            colours = follows.map({True: GOOD, False: BAD})
            axes.scatter(mine["smells"], mine["sight"], s=7, c=colours, alpha=0.7, linewidths=0)
            axes.set(xlim=(-0.6, 1.02), ylim=(-0.6, 1.02))
            axes.set_aspect("equal")
        axes = line[-1]
        mine = heading[(heading["arena"] == room) & heading["shift_deg"].notna()]
        shifts = {sensed: cells["shift_deg"] for sensed, cells in mine.groupby("sensed", sort=False)}
        told = ", ".join(f"{sensed} {shift.median():.0f}°" for sensed, shift in shifts.items())
        title = f"heading cells: {told}" if shifts else "no heading cells fire"
        tidy(axes, x="turned by (°)", y="cells", title=title, size=SMALL)
        axes.axvspan(45, 135, color=ABSENT, alpha=0.5, linewidth=0)
        for shift, colour in zip(shifts.values(), (GOOD, BAD, SOFT), strict=False):
            axes.hist(shift, bins=np.arange(-180, 181, 10), color=colour, alpha=0.6)
        axes.set(xlim=(-180, 180), xticks=QUARTERS)
    return figure
