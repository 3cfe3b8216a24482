"""Example cells of several populations: where they fire, and in which direction."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from cogmap.cells.rates.maps import RateMaps
from cogmap.cells.rates.tuning import Tuning
from cogmap.errors import CogmapError
from cogmap.plots.style import ABSENT, HUES, INK, QUARTERS, SMALL, SOFT, TINY, draw_bins, new_figure, tidy

THINNEST = 0.25
"""Height of a map over its width; that of a path is stretched to it."""


def plot_examples(populations: Mapping[str, Tuning], *, count: int = 6) -> Figure:
    """Draw `count` cells of each population, evenly chosen: rate map above, rate by true heading below.

    Both are fractions of their own peak, which is written above the map in Hz. Silent cells are left out.

    Raises
    ------
    CogmapError
        Without a population.
    """
    width = 1.7  # of a cell, in inches
    if not populations:
        raise CogmapError("no populations to draw; give the maps and curves of at least one")
    edges = next(iter(populations.values())).maps.edges
    aspect = max(float(np.ptp(edges.y) / np.ptp(edges.x)), THINNEST)
    height = width * (aspect + 0.45) + 0.5
    figure = new_figure(count * width + 0.7, height * len(populations))
    lines = figure.subfigures(len(populations), 1, squeeze=False, hspace=0.03)[:, 0]
    for line, (name, tuning) in zip(lines, populations.items(), strict=True):
        line.suptitle(name, fontsize=SMALL + 1, color=INK)
        panels = line.subplots(2, count, squeeze=False, height_ratios=[aspect, 0.45])
        firing = np.flatnonzero(np.nanmax(tuning.maps.rates, axis=(1, 2)) > 0)
        chosen = firing[np.arange(min(count, len(firing))) * len(firing) // count]
        for axes in panels[:, len(chosen) :].ravel():
            axes.set_axis_off()
        for (above, below), cell in zip(panels.T, chosen, strict=False):
            _draw_map(above, tuning.maps, int(cell), first=above is panels[0, 0])
            _draw_curve(below, tuning.curves[cell], first=above is panels[0, 0])
    return figure


def _draw_map(axes: Axes, maps: RateMaps, cell: int, *, first: bool) -> None:
    peak = float(np.nanmax(maps[cell]))
    x, y = ("x (m)", "y (m)") if first else ("", "")
    tidy(axes, x=x, y=y, title=f"cell {cell}: {peak:.2g} Hz", size=TINY)
    draw_bins(axes, maps.edges, maps[cell] / peak, "viridis", low=0.0, high=1.0)
    if np.ptp(maps.edges.y) > THINNEST * np.ptp(maps.edges.x):
        axes.set_aspect("equal")
    axes.set_facecolor(ABSENT)
    if not first:
        axes.set(xticks=[], yticks=[])


def _draw_curve(axes: Axes, curve: Float[np.ndarray, " bins"], *, first: bool) -> None:
    edges = np.linspace(-180, 180, len(curve) + 1)
    part = np.nan_to_num(curve / np.nanmax(curve))
    left, right, floor = edges[:-1], edges[1:], np.zeros(len(curve))
    corners = np.array([(left, floor), (left, part), (right, part), (right, floor)])
    tidy(axes, x="heading (°)" if first else "", y="rate / peak" if first else "")
    # One collection: as many bars are most of the time that the figure takes.
    colours = HUES((left + right) / 720 + 0.5)
    axes.add_collection(PolyCollection(list(corners.transpose(2, 0, 1)), facecolors=colours))
    axes.axhline(0, color=SOFT, linewidth=0.4)
    axes.set(xlim=(-180, 180), ylim=(0, 1.05), xticks=QUARTERS, yticks=[0, 1])
    if not first:
        axes.set(xticklabels=[], yticklabels=[])
