"""Looking round: who is right about the place before and after, and looks beside what is remembered."""

from __future__ import annotations

import numpy as np
import pandas as pd
from jaxtyping import UInt8
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cogmap.plots.rooms.room import draw_arrows
from cogmap.plots.style import BAD, GOOD, SMALL, new_figure, tidy, tidy_room

TITLES = ("the first look", "what it takes it for", "the last look", "what it takes it for then")


def plot_looking_round(
    looked: dict[str, tuple[pd.DataFrame, UInt8[np.ndarray, "4 height width 3"]]],
) -> Figure:
    """Draw, for each room, where views were taken for the right place (blue) or not (red), and looks.

    Where it says that it knows strokes are bold.

    Parameters
    ----------
    looked
        By name of the room: `x_m`, `y_m`, `heading_rad`, `right_before`, `right_after` and `resolved` of each
        query; the first look of one, what it is taken for, its last look, and what that is taken for.
    """
    figure = new_figure(12.0, 3.5 * len(looked))
    for (name, (table, views)), part in zip(
        looked.items(), figure.subfigures(len(looked), 1, squeeze=False).flat, strict=True
    ):
        part.suptitle(name.replace("_", " "), fontsize=SMALL + 1)
        plans, strip = part.subfigures(1, 2, width_ratios=[2.2, 1])
        for axes, when in zip(plans.subplots(1, 2), ("before", "after"), strict=True):
            _draw(axes, table, when)
        for axes, view, title in zip(strip.subplots(2, 2).flat, views, TITLES, strict=True):
            tidy(axes, title=title, size=SMALL - 1)
            axes.imshow(view, interpolation="nearest")
            axes.set_axis_off()
    return figure


def _draw(axes: Axes, table: pd.DataFrame, when: str) -> None:
    right = table[f"right_{when}"]
    known = table["resolved"] & (when == "after")
    said = f", {known.mean():.0%} say that they know" if when == "after" else ""
    tidy_room(axes, title=f"{when} turning: {right.mean():.1%} right{said}")
    poses = table[["x_m", "y_m", "heading_rad"]].to_numpy()
    for chosen, colour in ((right, GOOD), (~right, BAD)):
        for bold in (False, True):
            these = poses[(chosen & (known == bold)).to_numpy()]
            if len(these):
                draw_arrows(axes, these, 0.15, color=colour, width=0.005 if bold else 0.0025)
    axes.set(xlim=(-2, 2), ylim=(-1.5, 1.5))
