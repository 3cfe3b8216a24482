"""Catchment areas of goals: of descent on image differences, and of a policy that has a map."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

from arena.rooms.arena import Arena
from cogmap.plots.rooms.room import draw_arrows, draw_surfaces, frame_room
from cogmap.plots.style import ABSENT, BAD, INK, colour_bar, new_panels, tidy_room


class Field(NamedTuple):
    """What reaches a goal, on a grid of places."""

    goal: Float[np.ndarray, "3"]
    """m and rad."""
    corner: tuple[float, float]
    """m."""
    cell: float
    """m."""
    difference: Float[np.ndarray, "y x"]
    """Of what is seen to the goal's image, grey levels; NaN where no body can be."""
    caught: Bool[np.ndarray, "y x"]
    """Whether steepest descent on it leads to the goal."""
    ended_m: Float[np.ndarray, "y x"]
    """How far from the goal a journey that starts there ended; NaN where none starts."""


def plot_catchment(arena: Arena, fields: Sequence[Field]) -> Figure:
    """Draw above from where image differences lead to each goal, and below how near the policy gets.

    Above, the colour is how unlike the goal's image what is seen is, and cells from which steepest descent
    ends elsewhere are crossed.
    """
    x0, y0, x1, y1 = arena.walkable.bounds
    width = 12.0 / len(fields)
    height = 2 * ((width - 0.9) * (y1 - y0) / (x1 - x0) + 0.7)
    figure, panels = new_panels(12.0, height, 2, len(fields), squeeze=False)
    most = max(float(np.nanmax(field.difference)) for field in fields)
    for index, (field, above, below) in enumerate(zip(fields, *panels, strict=True)):
        free = np.isfinite(field.difference)
        caught = field.caught[free].mean()
        image = _draw(above, arena, field, field.difference, most)
        above.set_title(f"descent on image differences reaches it from {caught:.0%}", fontsize=8, color=INK)
        rows, columns = np.nonzero(free & ~field.caught)
        middles = [
            start + field.cell * (at + 0.5) for start, at in zip(field.corner, (columns, rows), strict=True)
        ]
        above.plot(*middles, "x", color=BAD, markersize=2.5, markeredgewidth=0.6, zorder=5)
        reached = (field.ended_m[free] <= 0.05).mean()
        ended = _draw(below, arena, field, 100 * field.ended_m, 5.0)
        below.set_title(f"the policy reaches it from {reached:.0%}", fontsize=8, color=INK)
        if index == len(fields) - 1:
            colour_bar(above, image, "image difference (grey levels)")
            colour_bar(below, ended, "end from the goal (cm)", extend="max")
    return figure


def _draw(axes: Axes, arena: Arena, field: Field, values: Float[np.ndarray, "y x"], most: float) -> AxesImage:
    tidy_room(axes)
    draw_surfaces(axes, arena)
    for text in axes.texts:
        text.set_visible(False)
    rows, columns = values.shape
    (x, y), cell = field.corner, field.cell
    drawn = axes.imshow(
        values,
        origin="lower",
        extent=(x, x + columns * cell, y, y + rows * cell),
        cmap=colormaps["viridis_r"].with_extremes(bad=ABSENT),
        vmin=0,
        vmax=most,
        zorder=1,
    )
    draw_arrows(axes, field.goal[None], 0.25, color=INK, width=0.01, zorder=9)
    frame_room(axes, arena.walkable.bounds, 0.1)
    return drawn
