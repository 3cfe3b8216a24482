"""Rate maps: where place cells fire."""

from __future__ import annotations

import numpy as np
import pandas as pd
from jaxtyping import Float, Int
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from cogmap.cells.rates.maps import RateMaps
from cogmap.errors import CogmapError
from cogmap.plots.style import ABSENT, colour_bar, new_panels, tidy, title_cell, title_sheet

COLOURS = colormaps["viridis"].with_extremes(bad=ABSENT)


def plot_rate_maps(
    maps: RateMaps, statistics: pd.DataFrame, count: int = 40, what: str = "place cells"
) -> Figure:
    """Draw a sheet of rate maps, each as a fraction of its peak, never visited bins grey.

    Cells are ordered like their fields in the room: in bands of equal number from the top to the bottom, from
    left to right within a band, those without a field last. The sheet takes them evenly from this order. The
    title of a cell that does not pass is red. All maps share one pair of axes, on which each is shifted.

    Parameters
    ----------
    maps
        Of all cells.
    statistics
        `place_statistics` of the same cells.
    count
        Maps on the sheet at most.
    what
        They are called in its title.

    Raises
    ------
    CogmapError
        For a count below one, statistics of other cells.
    """
    # Width of a map, and the room between maps and for their titles, in inches.
    panel, gap, title = 1.25, 0.09, 0.2
    maps.of_cells(len(statistics))
    if count < 1:
        raise CogmapError(f"count is {count}; give the number of maps to draw, at least 1")
    lines = _lines(statistics, min(count, len(maps)))
    low, high = (np.array([along[end] for along in maps.edges]) for end in (0, -1))
    inch = (high[0] - low[0]) / panel
    pitch = high - low + np.array([gap, gap + title]) * inch
    columns = max(len(line) for line in lines)
    width = max(columns * (panel + gap) + 1.2, 6.5)
    figure, axes = new_panels(width, len(lines) * pitch[1] / inch + 0.6)
    tidy(axes, x="x (m)", y="y (m)")
    axes.spines[:].set_visible(False)
    for row, line in enumerate(lines):
        for column, cell in enumerate(line):
            _draw_map(axes, maps, statistics, int(cell), shift=np.array([column, -row]) * pitch, inch=inch)
    shifts = np.arange(columns) * pitch[0], -np.arange(len(lines)) * pitch[1]
    for axis, shift, start, end in zip((axes.xaxis, axes.yaxis), shifts, low, high, strict=True):
        ticks = _ticks(start, end)
        labels = [f"{tick:g}".replace("-", "−") for tick in ticks]
        axis.set_ticks((shift[:, None] + ticks).ravel().tolist(), labels * len(shift))
    axes.set(
        xlim=(low[0] - 0.03 * inch, high[0] + shifts[0][-1] + 0.03 * inch),
        ylim=(low[1] + shifts[1][-1] - 0.03 * inch, high[1] + title * inch),
        aspect="equal",
    )
    drawn = f"{len(axes.images)} of {len(maps)} {what}: peak rate and spatial information"
    title_sheet(figure, drawn, statistics["passing"])
    colour_bar(axes, axes.images[0], "rate (fraction of peak)")
    return figure


def _lines(statistics: pd.DataFrame, count: int) -> list[Int[np.ndarray, " cells"]]:
    """Choose cells, one array per line of the sheet."""
    x, y = (statistics[name].to_numpy(dtype=float) for name in ("centre_x_m", "centre_y_m"))
    lines = -(-count // 8)
    chosen = []
    for band, places in zip(
        np.array_split(np.argsort(-y, kind="stable"), lines),
        np.array_split(np.arange(count), lines),
        strict=True,
    ):
        ordered = band[np.argsort(x[band], kind="stable")]
        chosen.append(ordered[((np.arange(len(places)) + 0.5) * len(band) / len(places)).astype(int)])
    return chosen


def _draw_map(
    axes: Axes,
    maps: RateMaps,
    statistics: pd.DataFrame,
    cell: int,
    *,
    shift: Float[np.ndarray, " 2"],
    inch: float,
) -> None:
    (x0, x1), (y0, y1) = (along[[0, -1]] + by for along, by in zip(maps.edges, shift, strict=True))
    shown = statistics.iloc[cell]
    peak, information = float(shown["peak_rate_hz"]), float(shown["spatial_information"])
    part = maps[cell] / (peak if peak > 0 else 1.0)
    drawn = axes.imshow(part, cmap=COLOURS, vmin=0, vmax=1, origin="lower", extent=(x0, x1, y0, y1))
    drawn.set(interpolation="nearest", label=f"cell {cell}")
    said = f"{peak:.1f} Hz, {information:.2f} bit/spike" if peak > 0 else "silent"
    title_cell(axes, (x0 + x1) / 2, y1 + 0.03 * inch, said, passing=bool(shown["passing"]))


def _ticks(low: float, high: float) -> Float[np.ndarray, " ticks"]:
    ticks = np.asarray(MaxNLocator(3).tick_values(low, high))
    return ticks[(ticks >= low) & (ticks <= high)]
