"""Rate maps over their autocorrelograms: how regular grid cells are."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from cogmap.cells.measures.autocorrelogram import autocorrelograms
from cogmap.cells.rates.bins import BinEdges
from cogmap.cells.rates.maps import RateMaps
from cogmap.errors import CogmapError
from cogmap.plots.style import BAD, INK, TINY, colour_bar, draw_bins, new_panels, tidy, title_sheet


def plot_grid_cells(maps: RateMaps, statistics: pd.DataFrame, count: int = 8) -> Figure:
    """Draw the most grid-like cells: rate maps, each as a fraction of its peak, above their autocorrelograms.

    The title of a cell tells its gridness and spacing, and is red when the cell does not pass. Bins never
    visited, and shifts that leave too little overlap, are grey.

    Parameters
    ----------
    maps
        Of all cells.
    statistics
        `grid_statistics` of the same cells.
    count
        Cells on the sheet at most.

    Raises
    ------
    CogmapError
        For a count below one, statistics of other cells.
    """
    maps.of_cells(len(statistics))
    if count < 1:
        raise CogmapError(f"count is {count}; give the number of cells to draw, at least 1")
    cells = np.argsort(-statistics["gridness"].to_numpy(dtype=float), kind="stable")[:count]
    panel = 1.35  # inches
    ny, nx = maps.visited.shape
    width, height = panel * len(cells) + 1.2, 2 * panel * ny / nx + 1.3
    figure, panels = new_panels(width, height, 2, len(cells), squeeze=False, sharex="row", sharey="row")
    correlograms = autocorrelograms(maps)
    rates = maps.rates[cells]
    peaks = np.nanmax(rates, axis=(1, 2), keepdims=True)
    # The bins of a shift are as wide, around none.
    shifts = BinEdges(*(maps.edges.side * (np.arange(2 * bins) - bins + 0.5) for bins in (nx, ny)))
    for axes, cell, part in zip(panels.T, cells, rates / np.where(peaks > 0, peaks, 1.0), strict=True):
        drawn = draw_bins(axes[0], maps.edges, part, "viridis", low=0.0, high=1.0)
        correlated = draw_bins(axes[1], shifts, correlograms[cell], "RdBu_r", low=-1.0, high=1.0)
        labels = (("x (m)", "y (m)"), ("shift (m)", "shift (m)")) if cell == cells[0] else (("", ""),) * 2
        for each, (x, y) in zip(axes, labels, strict=True):
            tidy(each, x=x, y=y)
            each.set_aspect("equal")
        shown = statistics.iloc[cell]
        lattice = f"{shown['spacing_m']:.2f} m" if np.isfinite(shown["spacing_m"]) else "no lattice"
        said = f"{shown['gridness']:.2f}, {lattice}".replace("-", "−")
        axes[0].set_title(said, fontsize=TINY, color=INK if shown["passing"] else BAD)
    heading = f"{len(cells)} of {len(maps)} cells as grid cells: gridness and spacing"
    title_sheet(figure, heading, statistics["passing"])
    colour_bar(panels[0, -1], drawn, "rate (of peak)")
    colour_bar(panels[1, -1], correlated, "correlation")
    return figure
