"""Confusion: where in a room a view is taken for that from the opposite pose."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.figure import Figure

from cogmap.cells.rates.bins import bin_edges, means_by_bin
from cogmap.errors import CogmapError
from cogmap.plots.style import ABSENT, colour_bar, new_figure, tidy_room


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
    figure = new_figure(5.4 * len(rooms), 3.8)
    colours = colormaps["magma_r"].with_extremes(bad=ABSENT)
    for axes, (name, views) in zip(
        figure.subplots(1, len(rooms), squeeze=False)[0], rooms.items(), strict=True
    ):
        positions = views[["x_m", "y_m"]].to_numpy()
        edges = bin_edges(positions, 0.25)
        ny, nx = edges.shape
        share = means_by_bin(edges.bin_of(positions), ny * nx, views[["confused"]].to_numpy(float))
        rate = 100 * views["confused"].mean()
        tidy_room(axes, title=f"{name.replace('_', ' ')}: {rate:.1f} % of {len(views):,} views confused")
        image = np.ma.masked_invalid(share.reshape(ny, nx))
        drawn = axes.pcolormesh(*edges, image, cmap=colours, vmin=0, vmax=1)
        colour_bar(axes, drawn, "share confused")
    return figure
