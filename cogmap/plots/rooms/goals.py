"""Goals and the views gathered at them, with the orientation that each has been given."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from arena.angles import wrap_angle
from arena.rooms.arena import Arena
from cogmap.plots.rooms.room import draw_surfaces
from cogmap.plots.style import SOFT, direction_colours, heading_bar, new_figure, tidy, tidy_room


def plot_goals(arena: Arena, views: pd.DataFrame) -> Figure:
    """Draw the views at each goal as strokes that point where the body looks, coloured by orientation.

    Where orientation is right a colour has the same direction at every goal. Beside it, orientation against
    true heading, a colour a ring.

    Parameters
    ----------
    arena
        The room.
    views
        `x_m`, `y_m`, `heading_rad`, `orientation_rad` (turned into the true frame) and `ring`, a row a view.
    """
    length = 0.16  # of a stroke, m
    figure = new_figure(11.0, 4.6)
    left, right = figure.subplots(1, 2, width_ratios=[1.5, 1])
    tidy_room(left, title=f"{views['ring'].nunique()} goals, {len(views):,} views at them")
    draw_surfaces(left, arena)
    heading, orientation = (views[name].to_numpy() for name in ("heading_rad", "orientation_rad"))
    colours = direction_colours(orientation)
    left.quiver(
        views["x_m"],
        views["y_m"],
        length * np.cos(heading),
        length * np.sin(heading),
        color=colours,
        angles="xy",
        scale_units="xy",
        scale=1,
        width=0.002,
        headwidth=0,
        headlength=0,
        headaxislength=0,
    )
    x0, y0, x1, y1 = arena.bounds
    left.set(xlim=(x0 - 0.35, x1 + 0.35), ylim=(y0 - 0.35, y1 + 0.35))
    heading_bar(left)
    tidy(right, x="true heading (°)", y="orientation (°)", title="orientation passed from ring to ring")
    right.plot([-180, 180], [-180, 180], color=SOFT, linewidth=0.6)
    degrees = [np.rad2deg(wrap_angle(angle)) for angle in (heading, orientation)]
    right.scatter(*degrees, s=4, c=views["ring"], cmap="viridis", linewidths=0)
    right.set(xlim=(-185, 185), ylim=(-185, 185), aspect="equal")
    return figure
