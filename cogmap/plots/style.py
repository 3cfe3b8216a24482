"""What the figures share: a sheet to draw on, colours, axes in metres, colour bars with units.

Colours and sizes are given to every artist, so that a figure looks the same whatever the user's settings
of matplotlib, and changes none of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, cast

import numpy as np
import pandas as pd
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure

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


def heading_bar(axes: Axes, *, pad: float = 0.02) -> None:
    """Put a colour bar of headings in degrees to the right of axes."""
    colour_bar(axes, direction_scale(), "heading (°)", pad=pad).set_ticks(QUARTERS.tolist())


def new_figure(width: float, height: float) -> Figure:
    """Make an empty white figure of this size in inches, laid out so that nothing overlaps."""
    return Figure(figsize=(width, height), dpi=110, facecolor="white", layout="constrained")


def tidy(axes: Axes, *, x: str = "", y: str = "", title: str = "") -> None:
    """Label axes and set them in small, dark type; without the frame's upper and right side."""
    axes.set_facecolor("white")
    axes.set_xlabel(x, fontsize=SMALL, color=INK)
    axes.set_ylabel(y, fontsize=SMALL, color=INK)
    axes.set_title(title, fontsize=SMALL, color=INK)
    axes.tick_params(labelsize=TINY, colors=INK, length=2.5, width=0.6)
    for spine in axes.spines.values():
        spine.set(color=INK, linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)


def title_sheet(figure: Figure, drawn: str, passing: pd.Series) -> None:
    """Head a sheet of cells: what is drawn, and how many of all cells pass."""
    note = "" if passing.all() else " (red: does not)"
    figure.suptitle(f"{drawn}; {passing.sum()} of {len(passing)} pass{note}", fontsize=SMALL, color=INK)


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
