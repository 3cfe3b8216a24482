"""Distances along the manifold of views against how far the body moved."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter

from cogmap.plots.style import BAD, colour_bar, new_figure, tidy, tidy_room

BINS = 60
BANDS = 25
"""Of motion distance, in each of which the median geodesic is taken."""


def plot_quasi_metric(pairs: pd.DataFrame, places: pd.DataFrame) -> Figure:
    """Draw image geodesics against motion distances, and where in the room they are stretched.

    Parameters
    ----------
    pairs
        `motion_m` and `geodesic` (no unit), a row a pair.
    places
        `x_m`, `y_m` and `distortion`, a row a view: 2 where geodesics are twice as long for the distance as
        they are on the whole.
    """
    figure = new_figure(11.0, 4.2)
    left, right = figure.subplots(1, 2, width_ratios=[1, 1.2])
    _draw_pairs(left, pairs["motion_m"].to_numpy(), pairs["geodesic"].to_numpy())
    tidy_room(right, title="distortion by place")
    farthest = max(float(np.abs(np.log2(places["distortion"])).quantile(0.98)), 0.05)
    drawn = right.scatter(
        places["x_m"],
        places["y_m"],
        c=places["distortion"],
        s=16,
        cmap="RdBu_r",
        norm=LogNorm(2**-farthest, 2**farthest),
        linewidths=0,
    )
    right.margins(0.08)
    bar = colour_bar(right, drawn, "geodesic / motion, over that of all pairs", extend="both")
    bar.ax.yaxis.set_major_locator(FixedLocator([0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.1, 1.25, 1.5, 2]))
    bar.ax.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    bar.ax.yaxis.set_minor_locator(NullLocator())
    return figure


def _draw_pairs(axes: Axes, motion: np.ndarray, geodesic: np.ndarray) -> None:
    tidy(
        axes,
        x="distance of the poses (m, 0.5 m/rad)",
        y="geodesic of the images (no unit)",
        title=f"{len(motion):,} pairs; median in red",
    )
    counts = axes.hist2d(motion, geodesic, bins=BINS, cmap="Greys", cmin=1)[3]
    colour_bar(axes, counts, "pairs")
    edges = np.quantile(motion, np.linspace(0, 1, BANDS + 1))
    band = np.clip(np.searchsorted(edges, motion, side="right") - 1, 0, BANDS - 1)
    medians = pd.DataFrame({"band": band, "motion": motion, "geodesic": geodesic}).groupby("band").median()
    axes.plot(medians["motion"], medians["geodesic"], color=BAD, linewidth=1.6)
