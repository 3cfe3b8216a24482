"""The quasi-metric: distances along the manifold of views against how far the body moved."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from cogmap.plots.style import BAD, SOFT, colour_bar, draw_headings, new_panels, plain_ticks, tidy, tidy_room

DISTORTION = "geodesic / motion, over that of all pairs"
TICKS = [0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 2.0]


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
    figure, panels = new_panels(5.0 * sum(widths), 4.2, 1, len(widths), width_ratios=widths)
    left, middle, *right = panels
    _draw_pairs(left, pairs["motion_m"].to_numpy(), pairs["geodesic"].to_numpy())
    _draw_headings(middle, places)
    if roomy:
        _draw_room(right[0], places)
    return figure


def _draw_headings(axes: Axes, places: pd.DataFrame) -> None:
    tidy(axes, x="heading (°)", y=DISTORTION, title="distortion by heading")
    draw_headings(axes, places["heading_rad"].to_numpy(), places["distortion"], size=9.0)
    axes.axhline(1, color=SOFT, linewidth=0.6)
    axes.set_yscale("log", base=2)
    plain_ticks(axes.yaxis, TICKS)


def _draw_room(axes: Axes, places: pd.DataFrame) -> None:
    tidy_room(axes, title="distortion by place")
    farthest = max(float(np.abs(np.log2(places["distortion"])).quantile(0.98)), 0.05)
    x, y, scale = places["x_m"], places["y_m"], LogNorm(2**-farthest, 2**farthest)
    drawn = axes.scatter(x, y, c=places["distortion"], s=16, cmap="RdBu_r", norm=scale, linewidths=0)
    axes.margins(0.08)
    plain_ticks(colour_bar(axes, drawn, DISTORTION, extend="both").ax.yaxis, TICKS)


def _draw_pairs(axes: Axes, motion: np.ndarray, geodesic: np.ndarray) -> None:
    # In each band of motion distance the median geodesic is taken.
    bands = 25
    title = f"{len(motion):,} pairs; median in red"
    tidy(axes, x="distance of the poses (m, 0.5 m/rad)", y="geodesic of the images (no unit)", title=title)
    counts = axes.hist2d(motion, geodesic, bins=60, cmap="Greys", cmin=1)[3]
    colour_bar(axes, counts, "pairs")
    edges = np.quantile(motion, np.linspace(0, 1, bands + 1))
    band = np.clip(np.searchsorted(edges, motion, side="right") - 1, 0, bands - 1)
    medians = pd.DataFrame({"band": band, "motion": motion, "geodesic": geodesic}).groupby("band").median()
    axes.plot(medians["motion"], medians["geodesic"], color=BAD, linewidth=1.6)
