"""How far from their goals journeys ended, by condition."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from cogmap.plots.style import BAD, GOOD, SOFT, new_panels, plain_ticks, tidy, tidy_legend

PEERS = ("true", "plain", "descent")
"""Conditions that are drawn dashed: who else goes there."""


def plot_reached(tables: Mapping[str, pd.DataFrame]) -> Figure:
    """Draw the share of journeys that ended within a distance, and within an angle, of the goal's pose.

    Parameters
    ----------
    tables
        `position_error_m` and `heading_error_deg` of journeys, by condition; the first is drawn bold.
    """
    figure, (left, right) = new_panels(11.0, 4.2, 1, 2)
    panels = (
        (left, "position_error_m", 100.0, "distance from the goal (cm)", 5.0),
        (right, "heading_error_deg", 1.0, "angle from the goal's heading (°)", 2.0),
    )
    colours = [GOOD, "#d98c2b", "#5b9a4a", "#8a62b0", "#4aa3a0", SOFT, "#7d6b57", BAD]
    for axes, column, scale, label, bound in panels:
        tidy(axes, x=label, y="journeys that ended so near (%)")
        axes.axvline(bound, color=SOFT, linewidth=0.8, linestyle=":")
        for colour, (name, table) in zip(colours, tables.items(), strict=False):
            sizes = np.sort(np.maximum(scale * table[column].to_numpy(), 1e-2))
            share = 100 * np.arange(1, len(sizes) + 1) / len(sizes)
            style = "--" if name in PEERS else "-"
            width = 2.2 if name == next(iter(tables)) else 1.3
            axes.step(sizes, share, style, where="post", color=colour, linewidth=width, label=name)
        axes.set(xscale="log", ylim=(0, 102))
        plain_ticks(axes.xaxis, [0.01, 0.1, 1.0, 10.0, 100.0])
    tidy_legend(right, loc="beside")
    return figure
