"""The quasi-metric: distances along the manifold of views against how far the body moved."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter

from cogmap.plots.style import (
    BAD,
    QUARTERS,
    SOFT,
    colour_bar,
    direction_colours,
    new_figure,
    tidy,
    tidy_room,
)

DISTORTION = "geodesic / motion, over that of all pairs"
TICKS = [0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.1, 1.25, 1.5, 2]


def plot_quasi_metric(pairs: pd.DataFrame, places: pd.DataFrame) -> Figure:
    """Draw image geodesics against motion distances, and where and in which direction they are stretched.

    There is a map of the room when the views come from all over it.

    Parameters
    ----------
    pairs
        `motion_m` and `geodesic` (no unit), a row a pair.
    places
        `x_m`, `y_m`, `heading_rad` and `distortion`, a row a view: 2 where geodesics are twice as long for
        the distance as they are on the whole.
    """
    # Places are worth a map when they extend over half a metre along x and y.
    roomy = bool((places[["x_m", "y_m"]].max() - places[["x_m", "y_m"]].min() > 0.5).all())
    widths = [1.0, 0.9, 1.2] if roomy else [1.0, 0.9]
    figure = new_figure(5.0 * sum(widths), 4.2)
    left, middle, *right = figure.subplots(1, len(widths), width_ratios=widths)
    _draw_pairs(left, pairs["motion_m"].to_numpy(), pairs["geodesic"].to_numpy())
    _draw_headings(middle, places)
    if roomy:
        _draw_room(right[0], places)
    return figure


def _draw_headings(axes: Axes, places: pd.DataFrame) -> None:
    tidy(axes, x="heading (°)", y=DISTORTION, title="distortion by heading")
    headings = places["heading_rad"].to_numpy()
    axes.scatter(np.rad2deg(headings), places["distortion"], s=9, c=direction_colours(headings), linewidths=0)
    axes.axhline(1, color=SOFT, linewidth=0.6)
    axes.set_yscale("log", base=2)
    axes.yaxis.set_major_locator(FixedLocator(TICKS))
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.set(xlim=(-185, 185), xticks=QUARTERS)


def _draw_room(axes: Axes, places: pd.DataFrame) -> None:
    tidy_room(axes, title="distortion by place")
    farthest = max(float(np.abs(np.log2(places["distortion"])).quantile(0.98)), 0.05)
    drawn = axes.scatter(
        places["x_m"],
        places["y_m"],
        c=places["distortion"],
        s=16,
        cmap="RdBu_r",
        norm=LogNorm(2**-farthest, 2**farthest),
        linewidths=0,
    )
    axes.margins(0.08)
    bar = colour_bar(axes, drawn, DISTORTION, extend="both")
    bar.ax.yaxis.set_major_locator(FixedLocator(TICKS))
    bar.ax.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    bar.ax.yaxis.set_minor_locator(NullLocator())


def _draw_pairs(axes: Axes, motion: np.ndarray, geodesic: np.ndarray) -> None:
    # In each band of motion distance the median geodesic is taken.
    bands = 25
    tidy(
        axes,
        x="distance of the poses (m, 0.5 m/rad)",
        y="geodesic of the images (no unit)",
        title=f"{len(motion):,} pairs; median in red",
    )
    counts = axes.hist2d(motion, geodesic, bins=60, cmap="Greys", cmin=1)[3]
    colour_bar(axes, counts, "pairs")
    edges = np.quantile(motion, np.linspace(0, 1, bands + 1))
    band = np.clip(np.searchsorted(edges, motion, side="right") - 1, 0, bands - 1)
    medians = pd.DataFrame({"band": band, "motion": motion, "geodesic": geodesic}).groupby("band").median()
    axes.plot(medians["motion"], medians["geodesic"], color=BAD, linewidth=1.6)
