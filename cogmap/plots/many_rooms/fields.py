"""Fields of the same cells in several rooms."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Shaped
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from cogmap.cells import RateMaps
from cogmap.errors import CogmapError
from cogmap.plots.style import INK, TINY, draw_bins, new_figure


def plot_fields(rooms: Mapping[str, RateMaps], count: int = 10) -> Figure:
    """Draw rate maps of the same cells in several rooms, a line a room and a column a cell.

    All maps of a cell share a scale, from 0 to its highest rate in any room, which stands above them. Bins
    never visited are grey.

    Parameters
    ----------
    rooms
        Maps of the same place cells by the name of the room.
    count
        Cells at most: taken evenly from those that fire most in the first room to those that fire least.

    Raises
    ------
    CogmapError
        Without a room.
    """
    shown = chosen(rooms, count)
    figure = new_figure(1.15 * len(shown) + 0.8, 0.95 * len(rooms) + 0.5)
    panels = figure.subplots(len(rooms), len(shown), squeeze=False)
    for column, cell in zip(panels.T, shown, strict=True):
        top = draw_cell(column, rooms, cell).norm.vmax
        column[0].set_title(f"cell {cell}: {top:.1f} Hz", fontsize=TINY, color=INK)
    for axes, name in zip(panels[:, 0], rooms, strict=True):
        axes.set_ylabel(name.replace("_", "\n"), fontsize=TINY, color=INK)
    fraction = ScalarMappable(Normalize(0.0, 1.0), "viridis")
    bar = figure.colorbar(fraction, ax=panels, shrink=0.85, aspect=30, pad=0.01)
    bar.set_label("rate (fraction of the highest)", fontsize=TINY, color=INK)
    bar.ax.tick_params(labelsize=TINY, colors=INK)
    return figure


def chosen(rooms: Mapping[str, RateMaps], count: int) -> list[int]:
    """Choose cells, those that fire most in the first room first.

    Raises
    ------
    CogmapError
        Without a room.
    """
    if not rooms:
        raise CogmapError("no rooms to draw; give rate maps of at least one")
    first = next(iter(rooms.values()))
    by_rate = np.argsort(-np.nanmax(first.rates, axis=(1, 2)))
    return list(map(int, by_rate[:: max(1, len(first) // count)][:count]))


def draw_cell(
    panels: Shaped[np.ndarray, "rooms"], rooms: Mapping[str, RateMaps], cell: int
) -> ScalarMappable:
    """Draw a cell in every room, and give the scale that its maps share, Hz."""
    top = max(float(np.nanmax(maps.rates[cell])) for maps in rooms.values())
    for axes, maps in zip(panels, rooms.values(), strict=True):
        drawn = draw_bins(axes, maps.edges, maps.rates[cell], "viridis", low=0.0, high=max(top, 1e-9))
        axes.set_aspect("equal")
        axes.set(xticks=[], yticks=[])
    return drawn
