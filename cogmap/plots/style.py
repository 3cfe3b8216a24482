"""What the figures share: a sheet to draw on, colours, axes in metres, colour bars with units.

Colours and sizes are given to every artist, so that a figure looks the same whatever the user's settings
of matplotlib, and changes none of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import Any, Literal, cast

import numpy as np
import pandas as pd
from jaxtyping import Float
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.cm import ScalarMappable
from matplotlib.collections import QuadMesh
from matplotlib.colorbar import Colorbar
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import FixedLocator, Locator, NullLocator, StrMethodFormatter
from numpy.typing import ArrayLike

from cogmap.cells.rates.bins import BinEdges

SMALL, TINY = 9.0, 7.0
"""Sizes of text in points: labels and titles; ticks and what stands in a small panel."""
INK = "#22252a"
SOFT = "#8a9099"
ABSENT = "#d5d8dc"
"""Where there is no value."""
GOOD, BAD = "#1f6fb4", "#c8452d"
QUARTERS = np.array([-180, -90, 0, 90, 180])
"""Ticks in degrees for an angle."""


def _hues(count: int) -> Float[np.ndarray, "count 3"]:
    """Colours of equal lightness and chroma evenly around the circle of hues, in OKLab.

    References
    ----------
    B. Ottosson (2020), A perceptual color space for image processing.
    """
    angle = 2 * np.pi * np.arange(count) / count
    lightness, chroma = 0.72, 0.12
    lab = np.stack([np.full(count, lightness), chroma * np.cos(angle), chroma * np.sin(angle)], axis=1)
    cones = lab @ np.array(
        [
            [1, 1, 1],
            [0.3963377774, -0.1055613458, -0.0894841775],
            [0.2158037573, -0.0638541728, -1.2914855480],
        ]
    )
    linear = cones**3 @ np.array(
        [
            [4.0767416621, -1.2684380046, -0.0041960863],
            [-3.3077115913, 2.6097574011, -0.7034186147],
            [0.2309699292, -0.3413193965, 1.7076147010],
        ]
    )
    linear = np.clip(linear, 0, 1)
    colours: np.ndarray = np.where(linear > 0.0031308, 1.055 * linear ** (1 / 2.4) - 0.055, 12.92 * linear)
    return colours


HUES = ListedColormap(cast("Sequence[tuple[float, float, float]]", _hues(360)), name="hues")
"""For angles: equally light all around, and its end is its beginning."""


def direction_colours(angles: Float[np.ndarray, " angles"]) -> Float[np.ndarray, "angles 4"]:
    """Give angles in rad their cyclic colours, grey where NaN; −π and π are the same."""
    turn = np.nan_to_num(angles / (2 * np.pi) + 0.5) % 1
    colours: np.ndarray = HUES(turn)
    colours[np.isnan(angles)] = (0.6, 0.6, 0.6, 1.0)
    return colours


def direction_scale() -> ScalarMappable:
    """Make what a colour bar of directions in degrees shows."""
    return ScalarMappable(Normalize(-180, 180), HUES)


def heading_bar(axes: Axes, label: str = "heading (°)", *, pad: float = 0.02) -> None:
    """Put a colour bar of headings in degrees to the right of axes."""
    colour_bar(axes, direction_scale(), label, pad=pad).set_ticks(QUARTERS.tolist())


class SelfShown(Figure):
    """A figure that shows itself as the last line of a notebook cell, whatever matplotlib is told there."""

    def _repr_png_(self) -> bytes:
        drawn = BytesIO()
        self.savefig(drawn, format="png")
        return drawn.getvalue()


def new_figure(width: float, height: float) -> Figure:
    """Make an empty white figure of this size in inches, laid out so that nothing overlaps."""
    return SelfShown(figsize=(width, height), dpi=110, facecolor="white", layout="constrained")


def new_panels(
    width: float, height: float, rows: int = 1, columns: int = 1, **options: Any
) -> tuple[Figure, Any]:
    """Make a figure as `new_figure` does, and its panels as `Figure.subplots` does, with the same options."""
    figure = new_figure(width, height)
    return figure, figure.subplots(rows, columns, **options)


def tidy(axes: Axes, *, x: str = "", y: str = "", title: str = "", size: float = SMALL) -> None:
    """Label axes, their title in this size, in dark type; without the frame's upper and right side."""
    axes.set_facecolor("white")
    axes.set_xlabel(x, fontsize=SMALL, color=INK)
    axes.set_ylabel(y, fontsize=SMALL, color=INK)
    axes.set_title(title, fontsize=size, color=INK)
    axes.tick_params(labelsize=TINY, colors=INK, length=2.5, width=0.6)
    for spine in axes.spines.values():
        spine.set(color=INK, linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)


def plain_ticks(axis: Axis, ticks: Locator | Sequence[float]) -> None:
    """Write numbers without powers of ten at these ticks alone, also along a logarithmic axis."""
    axis.set_major_locator(ticks if isinstance(ticks, Locator) else FixedLocator(ticks))
    axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_locator(NullLocator())


def draw_headings(
    axes: Axes, headings: Float[np.ndarray, " angles"], values: ArrayLike, *, size: float, margin: float = 5.0
) -> None:
    """Draw values over headings (rad) as dots of their cyclic colours, along an axis in degrees."""
    axes.scatter(np.rad2deg(headings), values, s=size, c=direction_colours(headings), linewidths=0)
    axes.set(xlim=(-180 - margin, 180 + margin), xticks=QUARTERS)


def title_sheet(figure: Figure, drawn: str, passing: pd.Series) -> None:
    """Head a sheet of cells: what is drawn, and how many of all cells pass."""
    note = "" if passing.all() else " (red: does not)"
    figure.suptitle(f"{drawn}; {passing.sum()} of {len(passing)} pass{note}", fontsize=SMALL, color=INK)


def title_cell(axes: Axes, x: float, y: float, said: str, *, passing: bool) -> None:
    """Write above a cell of a sheet, in red when it does not pass."""
    colour = INK if passing else BAD
    axes.text(x, y, said, ha="center", va="bottom", fontsize=TINY, color=colour)


def tidy_room(axes: Axes, *, title: str = "") -> None:
    """Make axes a plan of the room: metres, the same along x and y."""
    tidy(axes, x="x (m)", y="y (m)", title=title)
    axes.set_aspect("equal")


def tidy_legend(
    axes: Axes, *, title: str = "", loc: Literal["best", "lower right", "beside"] = "best"
) -> None:
    """Explain the labelled artists, in small type; beside the axes nothing is covered."""
    options: dict[str, Any] = {"loc": loc}
    if loc == "beside":
        options = {"loc": "upper left", "bbox_to_anchor": (1.02, 1.0), "borderaxespad": 0.0}
    legend = axes.legend(title=title, fontsize=TINY, title_fontsize=TINY, labelcolor=INK, **options)
    legend.get_title().set_color(INK)
    legend.get_frame().set(facecolor="white", edgecolor="none", alpha=0.85)


def sheet_legend(figure: Figure | SubFigure, columns: int, **options: Any) -> None:
    """Explain below all axes of a figure what they share; options are those of `Figure.legend`."""
    look: dict[str, Any] = {"fontsize": SMALL, "labelcolor": INK, "frameon": False}
    figure.legend(loc="outside lower center", ncols=columns, **look, **options)


def draw_bins(
    axes: Axes, edges: BinEdges, values: Float[np.ndarray, "ny nx"], colours: str, *, low: float, high: float
) -> QuadMesh:
    """Draw a value per bin of a room in one of matplotlib's colour maps, grey where it is NaN."""
    grey_without = colormaps[colours].with_extremes(bad=ABSENT)
    return axes.pcolormesh(*edges, values, cmap=grey_without, vmin=low, vmax=high)


def colour_bar(
    axes: Axes,
    scale: ScalarMappable,
    label: str,
    *,
    extend: Literal["neither", "max", "both"] = "neither",
    pad: float = 0.02,
) -> Colorbar:
    """Put a labelled colour bar to the right of axes; it extends where colours hold all that is beyond."""
    figure = cast("Figure", axes.get_figure(root=True))
    bar = figure.colorbar(scale, ax=axes, shrink=0.85, aspect=30, pad=pad, extend=extend)
    bar.set_label(label, fontsize=SMALL, color=INK)
    bar.ax.tick_params(labelsize=TINY, colors=INK, length=2.5, width=0.6)
    bar.outline.set_visible(False)
    return bar
