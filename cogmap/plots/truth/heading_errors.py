"""Heading errors: how well the learnt phase tells the heading."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from arena.angles import wrap_angle
from cogmap.cells.rates.bins import bin_edges, means_by_bin
from cogmap.inputs import check_array
from cogmap.plots.style import (
    ABSENT,
    BAD,
    GOOD,
    INK,
    QUARTERS,
    SOFT,
    colour_bar,
    direction_colours,
    new_figure,
    tidy,
    tidy_legend,
    tidy_room,
)


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
    figure = new_figure(3.5 * sum(widths), 3.7)
    left, middle, *right = figure.subplots(1, len(widths), width_ratios=widths)
    _draw_agreement(left, headings_estimated, headings_true)
    _draw_sizes(middle, np.rad2deg(np.abs(np.angle(error))))
    if positions is not None:
        _draw_room(right[0], error, positions)
    return figure


def _degrees(angles: Float[np.ndarray, " views"]) -> Float[np.ndarray, " views"]:
    return np.asarray(np.rad2deg(wrap_angle(angles.astype(float))))


def _draw_agreement(
    axes: Axes, estimated: Float[np.ndarray, " views"], true: Float[np.ndarray, " views"]
) -> None:
    tidy(axes, x="true heading (°)", y="learnt heading, aligned (°)", title="learnt against true heading")
    axes.plot([-180, 180], [-180, 180], color=SOFT, linewidth=0.6)
    axes.scatter(_degrees(true), _degrees(estimated), s=4, c=direction_colours(estimated), linewidths=0)
    axes.set(xlim=(-185, 185), ylim=(-185, 185), xticks=QUARTERS, yticks=QUARTERS, aspect="equal")


def _draw_sizes(axes: Axes, size: Float[np.ndarray, " views"]) -> None:
    median, most = np.percentile(size, [50, 95])
    limit = max(3 * float(most), 1e-3)
    beyond = int(np.count_nonzero(size > limit))
    tidy(axes, x="size of the heading error (°)", y="views", title=f"{len(size):,} views")
    axes.hist(np.minimum(size, limit), bins=np.linspace(0, limit, 46).tolist(), color=SOFT)
    axes.axvline(median, color=GOOD, linewidth=1.4, label=f"median {median:.1f}°")
    axes.axvline(most, color=BAD, linewidth=1.4, linestyle="--", label=f"95 % below {most:.1f}°")
    axes.set_xlim(0, limit)
    tidy_legend(axes, title=f"{beyond} beyond {limit:.0f}°, in the last bin" if beyond else "")


def _draw_room(axes: Axes, error: np.ndarray, positions: Float[np.ndarray, "views 2"]) -> None:
    # Bins of 20 cm hold a few views each.
    edges = bin_edges(positions, 0.2)
    ny, nx = edges.shape
    parts = np.stack([error.real, error.imag], axis=1)
    real, imaginary = means_by_bin(edges.bin_of(positions), ny * nx, parts).T
    mean = np.rad2deg(np.arctan2(imaginary, real)).reshape(ny, nx)
    limit = max(float(np.nanpercentile(np.abs(mean), 98)), 1e-3)
    tidy_room(axes, title="mean error over the room")
    colours = colormaps["RdBu_r"].with_extremes(bad=ABSENT)
    drawn = axes.pcolormesh(*edges, np.ma.masked_invalid(mean), cmap=colours, vmin=-limit, vmax=limit)
    bar = colour_bar(axes, drawn, "learnt − true heading (°)", extend="both")
    bar.ax.axhline(0, color=INK, linewidth=0.6)
