"""Localisation errors: how well views are placed."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cogmap.errors import CogmapError
from cogmap.plots.style import BAD, GOOD, SOFT, new_panels, tidy, tidy_legend


def plot_localisation(table: pd.DataFrame) -> Figure:
    """Draw the share of views whose errors are below so many cm, and so many degrees, on logarithmic axes.

    Parameters
    ----------
    table
        Columns `position_error_m`, `heading_error_deg`, and the same of `nearest_`; rows with NaN are left
        out.

    Raises
    ------
    CogmapError
        For a table without a view.
    """
    kinds = (("", "interpolated", GOOD), ("nearest_", "nearest view", BAD))
    table = table.dropna()
    if table.empty:
        raise CogmapError("no view has a place; give at least one")
    figure, (left, right) = new_panels(10.0, 4.0, 1, 2, sharey=True)
    tidy(left, x="position error (cm)", y="share of views", title=f"{len(table):,} views")
    tidy(right, x="heading error (°)")
    for prefix, name, colour in kinds:
        _draw(left, 100 * table[f"{prefix}position_error_m"].to_numpy(), name, " cm", colour)
        _draw(right, table[f"{prefix}heading_error_deg"].to_numpy(), name, "°", colour)
    left.set(ylim=(0, 1.25), yticks=[0, 0.25, 0.5, 0.75, 1])
    return figure


def _draw(axes: Axes, errors: np.ndarray, name: str, unit: str, colour: str) -> None:
    median, most = np.percentile(errors, [50, 95])
    said = f"{name}: median {median:.3g}{unit}, 95 % below {most:.3g}{unit}"
    # Errors of nothing at all have no place on a logarithmic axis.
    axes.ecdf(np.maximum(errors, 1e-3), color=colour, linewidth=1.6, label=said)
    axes.set_xscale("log")
    axes.axhline(0.5, color=SOFT, linewidth=0.6, linestyle=":")
    tidy_legend(axes)
