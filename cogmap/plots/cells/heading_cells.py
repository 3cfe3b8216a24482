"""Tuning curves: which direction head-direction cells fire in."""

from __future__ import annotations

import numpy as np
import pandas as pd
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from cogmap.errors import CogmapError
from cogmap.plots.style import (
    INK,
    SOFT,
    TINY,
    direction_colours,
    heading_bar,
    new_panels,
    title_cell,
    title_sheet,
)


def plot_tuning_curves(
    curves: Float[np.ndarray, "cells bins"],
    statistics: pd.DataFrame,
    count: int = 24,
    what: str = "head-direction cells",
) -> Figure:
    """Draw a sheet of polar tuning curves, coloured by preferred direction.

    Direction is the true heading, 0° to the right (along x), counter-clockwise. Every curve fills its circle,
    whose rim is the rate in Hz beside it; the dark line is the mean vector, of length 1 at the rim. Cells are
    taken evenly in the order of their preferred directions, those that have none last. The title of a cell
    that does not pass is red. All circles share one pair of axes, on which each is shifted.

    Parameters
    ----------
    curves
        `tuning_curves` of all cells in Hz, NaN in bins without views.
    statistics
        `heading_statistics` of the same cells.
    count
        Curves on the sheet at most.
    what
        They are called in its title.

    Raises
    ------
    CogmapError
        For a count below one, statistics of other cells.
    """
    # Lengths are in radii of a circle: those in an inch, and from one circle to the next.
    inch, pitch = 1.6, 2.75
    if len(curves) != len(statistics):
        raise CogmapError(
            f"{len(curves)} curves and statistics of {len(statistics)} cells; take those of the same cells"
        )
    if count < 1:
        raise CogmapError(f"count is {count}; give the number of curves to draw, at least 1")
    ordered = np.argsort(statistics["preferred_direction_rad"].to_numpy(dtype=float), kind="stable")
    shown = min(count, len(ordered))
    cells = ordered[((np.arange(shown) + 0.5) * len(ordered) / shown).astype(int)]
    columns = min(6, len(cells))
    lines = -(-len(cells) // columns)
    right, bottom = pitch * (columns - 1) + 1.4, -pitch * (lines - 1) - 1.25
    figure, axes = new_panels(max((right + 1.55) / inch + 1.1, 6.5), (1.6 - bottom) / inch + 0.4)
    axes.set_axis_off()
    for index, cell in enumerate(cells):
        centre = pitch * np.array([index % columns, -(index // columns)])
        _draw_circle(axes, centre, named=index == 0)
        _draw_curve(axes, curves[cell], statistics.iloc[cell], f"cell {cell}", centre)
    axes.set(xlim=(-1.55, right), ylim=(bottom, 1.6), aspect="equal")
    drawn = f"{len(cells)} of {len(curves)} {what}: rate (Hz) by true heading (°), mean vector"
    title_sheet(figure, drawn, statistics["passing"])
    heading_bar(axes, "preferred direction (°)")
    return figure


def _draw_circle(axes: Axes, centre: Float[np.ndarray, " 2"], *, named: bool) -> None:
    x, y = centre
    axes.add_patch(Circle((x, y), 1, facecolor="none", edgecolor=SOFT, linewidth=0.6))
    axes.plot([x - 1, x + 1, np.nan, x, x], [y, y, np.nan, y - 1, y + 1], color=SOFT, linewidth=0.4)
    if named:
        for name, dx, dy in (("0°", 1.13, 0), ("90°", 0, 1.1), ("±180°", -1.23, 0), ("−90°", 0, -1.12)):
            axes.text(x + dx, y + dy, name, ha="center", va="center", fontsize=TINY - 1, color=INK)


def _draw_curve(
    axes: Axes, curve: Float[np.ndarray, " bins"], shown: pd.Series, label: str, centre: np.ndarray
) -> None:
    length, direction = float(shown["mean_vector_length"]), float(shown["preferred_direction_rad"])
    (colour,) = direction_colours(np.array([direction]))
    highest = float(np.nan_to_num(curve).max())
    angle = -np.pi + (np.arange(len(curve) + 1) + 0.5) * 2 * np.pi / len(curve)
    rays = np.stack([np.cos(angle), np.sin(angle)])
    radius = np.append(curve, curve[0]) / (highest if highest > 0 else 1.0)
    x, y = centre[:, None] + radius * rays
    axes.fill(*(centre[:, None] + np.nan_to_num(radius) * rays), color=colour, alpha=0.35, linewidth=0)
    axes.plot(x, y, color=colour, linewidth=1.4, label=label)
    tip = centre + length * np.array([np.cos(direction), np.sin(direction)])
    axes.plot(*np.stack([centre, tip], axis=1), color=INK, linewidth=1.2)
    axes.text(centre[0] + 0.74, centre[1] + 0.74, f"{highest:.1f} Hz", fontsize=TINY - 1, color=INK)
    said = f"vector {length:.2f}, {np.rad2deg(direction):.0f}°".replace("-", "−") if length >= 0 else "silent"
    title_cell(axes, centre[0], centre[1] + 1.22, said, passing=bool(shown["passing"]))
