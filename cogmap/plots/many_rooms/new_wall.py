"""A new wall: fields beside it, and errors while the map lives on."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from arena import Arena
from cogmap.cells import RateMaps
from cogmap.errors import CogmapError
from cogmap.plots.style import (
    BAD,
    GOOD,
    INK,
    SMALL,
    TINY,
    colour_bar,
    draw_bins,
    new_figure,
    tidy,
    tidy_legend,
)

CELLS = 6


def plot_new_wall(
    room: Arena, before: RateMaps, kept: RateMaps, after: RateMaps, rounds: pd.DataFrame
) -> Figure:
    """Draw rate maps of the six cells that change most, and errors over the views since the wall stands.

    Parameters
    ----------
    room
        With the wall as its last box.
    before, kept, after
        Maps of the same cells before the wall, on the first walk beside it, and when the map has lived on.
    rounds
        `views`, and the median errors over those of a map of the changed room alone, `heading_over_alone` and
        `position_over_alone`, a row a stretch of the walk.

    Raises
    ------
    CogmapError
        Without a row.
    """
    if rounds.empty:
        raise CogmapError("no rounds to draw; give a table with at least one row")
    figure = new_figure(9.4, 6.6)
    above, below = figure.subfigures(2, 1, squeeze=False, height_ratios=[4.2, 2.4])[:, 0]
    panels = above.subplots(3, CELLS)
    differs = np.nansum(np.abs(kept.rates - before.rates), axis=(1, 2))
    shown = np.argsort(-differs)[:CELLS]
    for line, (label, maps) in zip(
        panels, {"before": before, "first walk": kept, "lived on": after}.items(), strict=True
    ):
        for axes, cell in zip(line, shown, strict=True):
            top = max(float(np.nanmax(each.rates[cell])) for each in (before, kept, after))
            drawn = draw_bins(axes, maps.edges, maps.rates[cell], "viridis", low=0.0, high=top)
            if maps is not before:
                axes.add_patch(
                    Polygon(room.boxes[-1].outline, facecolor="white", edgecolor=INK, linewidth=0.8)
                )
            axes.set_aspect("equal")
            axes.set(xticks=[], yticks=[])
            if maps is before:
                axes.set_title(f"cell {cell}", fontsize=TINY, color=INK)
        line[0].set_ylabel(label, fontsize=SMALL, color=INK)
        colour_bar(line[-1], drawn, "Hz")
    axes = below.subplots()
    tidy(
        axes, x="views beside the wall", y="median error, over that\nof a map of this room alone", size=SMALL
    )
    for column, colour, label in (
        ("heading_over_alone", GOOD, "heading"),
        ("position_over_alone", BAD, "position"),
    ):
        axes.plot(rounds["views"], rounds[column], "o-", color=colour, label=label, markersize=4)
    axes.axhline(1.2, color=INK, linewidth=0.8, linestyle="--")
    axes.set_ylim(bottom=0)
    tidy_legend(axes)
    return figure
