"""Nearest views: what each measure of likeness takes for the same view."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from jaxtyping import UInt8
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cogmap.plots.style import INK, SMALL, new_figure, tidy, tidy_legend


def plot_likeness(
    nearest: pd.DataFrame, pictures: Mapping[str, UInt8[np.ndarray, "queries height width 3"]]
) -> Figure:
    """Draw how far in pose the view most like a query is, by measure, and some of these views.

    Parameters
    ----------
    nearest
        `measure`, `position_error_m` and `heading_error_deg`, a row for each query and measure.
    pictures
        The queries, and for each measure the views that it finds nearest, by name.
    """
    errors = {
        "position_error_m": "position error of the nearest view (m)",
        "heading_error_deg": "heading error (°)",
    }
    figure = new_figure(11.0, 8.5)
    upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=[1, 1.55])[:, 0]
    for axes, (column, label) in zip(upper.subplots(1, 2), errors.items(), strict=True):
        _draw_errors(axes, nearest, column, label)
    grid = lower.subplots(len(next(iter(pictures.values()))), len(pictures), squeeze=False)
    for panels, (name, views) in zip(grid.T, pictures.items(), strict=True):
        for row, (axes, view) in enumerate(zip(panels, views, strict=True)):
            axes.imshow(view)
            axes.set_axis_off()
            if row == 0:
                axes.set_title(name.replace("_", " "), fontsize=SMALL, color=INK)
    return figure


def _draw_errors(axes: Axes, nearest: pd.DataFrame, column: str, label: str) -> None:
    tidy(axes, x=label, y="share of queries")
    axes.set_xscale("log")
    for rank, (name, rows) in enumerate(nearest.groupby("measure", sort=False)):
        values = rows[column].clip(lower=1e-3)
        label = f"{str(name).replace('_', ' ')}: median {values.median():.2g}"
        axes.ecdf(values, color=colormaps["tab10"](rank), linewidth=1.5, label=label)
    axes.set_ylim(0, 1)
    tidy_legend(axes, loc="lower right")
