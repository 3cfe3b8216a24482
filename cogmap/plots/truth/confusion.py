"""Confusion: where in a room a view is taken for that from the opposite pose."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd
from matplotlib.figure import Figure

from cogmap.cells.rates.bins import bin_edges, means_by_bin
from cogmap.errors import CogmapError
from cogmap.plots.style import colour_bar, draw_bins, new_panels, tidy_room


def plot_confusion(rooms: Mapping[str, pd.DataFrame]) -> Figure:
    """Draw the share of confused views by place, grey without a view.

    Parameters
    ----------
    rooms
        `x_m`, `y_m` and `confused`, a row a view, by the name of the room.

    Raises
    ------
    CogmapError
        Without a room.
    """
    if not rooms:
        raise CogmapError("no rooms to draw; give at least one table")
    figure, panels = new_panels(5.4 * len(rooms), 3.8, 1, len(rooms), squeeze=False)
    for axes, (name, views) in zip(panels[0], rooms.items(), strict=True):
        positions = views[["x_m", "y_m"]].to_numpy()
        edges = bin_edges(positions, 0.25)
        ny, nx = edges.shape
        share = means_by_bin(edges.bin_of(positions), ny * nx, views[["confused"]].to_numpy(float))
        rate = 100 * views["confused"].mean()
        tidy_room(axes, title=f"{name.replace('_', ' ')}: {rate:.1f} % of {len(views):,} views confused")
        drawn = draw_bins(axes, edges, share.reshape(ny, nx), "magma_r", low=0.0, high=1.0)
        colour_bar(axes, drawn, "share confused")
    return figure
