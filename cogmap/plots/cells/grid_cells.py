"""Rate maps over their autocorrelograms: how regular grid cells are."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.figure import Figure

from cogmap.cells.measures.autocorrelogram import autocorrelograms
from cogmap.cells.rates.maps import RateMaps
from cogmap.errors import CogmapError
from cogmap.plots.cells.place_cells import COLOURS
from cogmap.plots.style import ABSENT, BAD, INK, TINY, colour_bar, new_panels, tidy, title_sheet


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
    figure, panels = new_panels(
        panel * len(cells) + 1.2, 2 * panel + 0.9, 2, len(cells), squeeze=False, sharex="row", sharey="row"
    )
    x, y = maps.edges
    wide, high = x[-1] - x[0] - maps.edges.side / 2, y[-1] - y[0] - maps.edges.side / 2
    correlograms = autocorrelograms(maps)
    for column, cell in enumerate(cells):
        shown, peak = statistics.iloc[cell], np.nanmax(maps[cell])
        room, lags = panels[:, column]
        known = np.isfinite(shown["spacing_m"])
        spacing = f"\nspacing {shown['spacing_m']:.2f} m" if known else "\nno lattice"
        named = {"x": "x (m)", "y": "y (m)"} if column == 0 else {}
        said = f"gridness {shown['gridness']:.2f}{spacing}".replace("-", "−")
        tidy(room, title=said, size=TINY, **named)
        room.title.set_color(INK if shown["passing"] else BAD)
        part = maps[cell] / (peak if peak > 0 else 1.0)
        drawn = room.imshow(
            part, cmap=COLOURS, vmin=0, vmax=1, origin="lower", extent=(x[0], x[-1], y[0], y[-1])
        )
        named = {"x": "shift along x (m)", "y": "along y (m)"} if column == 0 else {}
        tidy(lags, **named)
        signed = colormaps["RdBu_r"].with_extremes(bad=ABSENT)
        correlated = lags.imshow(
            correlograms[cell],
            cmap=signed,
            vmin=-1,
            vmax=1,
            origin="lower",
            extent=(-wide, wide, -high, high),
        )
    title_sheet(figure, f"{len(cells)} of {len(maps)} cells as grid cells", statistics["passing"])
    for axes, scale, label in (
        (panels[0], drawn, "rate (of peak)"),
        (panels[1], correlated, "correlation"),
    ):
        colour_bar(axes[-1], scale, label)
    return figure
