"""Heading errors: how well the learnt phase tells the heading."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cogmap.cells.rates.bins import bin_edges, means_by_bin
from cogmap.inputs import check_array
from cogmap.plots.style import (
    INK,
    QUARTERS,
    colour_bar,
    direction_colours,
    draw_bins,
    new_panels,
    tidy,
    tidy_room,
)
from cogmap.plots.truth.errors import draw_agreement, draw_sizes


def plot_compass(
    headings_estimated: Float[np.ndarray, " views"],
    headings_true: Float[np.ndarray, " views"],
    positions: Float[np.ndarray, "views 2"] | None = None,
) -> Figure:
    """Draw learnt against true heading, how large the errors are, and where in the room they come from.

    The error is estimate − truth, in (−180°, 180°]. The histogram counts its size; its last bin holds all
    that is beyond. The map shows its circular mean in bins of 20 cm, grey without a view; the colours
    reach as far as 98 % of the bins do.

    Parameters
    ----------
    headings_estimated
        In rad, turned into the true frame.
    headings_true
        In rad.
    positions
        Where the views were taken, m; without them there is no map.

    Raises
    ------
    CogmapError
        For values that are not finite or shapes that do not fit.
    """
    check_array("headings_estimated", headings_estimated, (None,))
    check_array("headings_true", headings_true, (len(headings_estimated),))
    if positions is not None:
        check_array("positions", positions, (len(headings_estimated), 2))
    error = np.exp(1j * (headings_estimated.astype(float) - headings_true))
    widths = [1.0, 1.0] if positions is None else [1.0, 1.0, 1.45]
    figure, panels = new_panels(3.5 * sum(widths), 3.7, 1, len(widths), width_ratios=widths)
    left, middle, *right = panels
    tidy(left, x="true heading (°)", y="learnt heading, aligned (°)", title="learnt against true heading")
    draw_agreement(left, headings_true, headings_estimated, direction_colours(headings_estimated))
    left.set(xticks=QUARTERS, yticks=QUARTERS)
    tidy(middle, x="size of the heading error (°)", y="views", title=f"{len(error):,} views")
    draw_sizes(middle, np.rad2deg(np.abs(np.angle(error))), "°", 3.0)
    if positions is not None:
        _draw_room(right[0], error, positions)
    return figure


def _draw_room(axes: Axes, error: np.ndarray, positions: Float[np.ndarray, "views 2"]) -> None:
    # Bins of 20 cm hold a few views each.
    edges = bin_edges(positions, 0.2)
    ny, nx = edges.shape
    parts = np.stack([error.real, error.imag], axis=1)
    real, imaginary = means_by_bin(edges.bin_of(positions), ny * nx, parts).T
    mean = np.rad2deg(np.arctan2(imaginary, real)).reshape(ny, nx)
    limit = max(float(np.nanpercentile(np.abs(mean), 98)), 1e-3)
    tidy_room(axes, title="mean error over the room")
    drawn = draw_bins(axes, edges, mean, "RdBu_r", low=-limit, high=limit)
    bar = colour_bar(axes, drawn, "learnt − true heading (°)", extend="both")
    bar.ax.axhline(0, color=INK, linewidth=0.6)
