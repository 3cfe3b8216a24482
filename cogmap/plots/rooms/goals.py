"""Goals and the views gathered at them, with the orientation that each has been given."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from arena.rooms.arena import Arena
from cogmap.plots.rooms.room import draw_arrows, draw_surfaces, frame_room
from cogmap.plots.style import direction_colours, heading_bar, new_panels, tidy, tidy_room
from cogmap.plots.truth.errors import draw_agreement


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
    figure, (left, right) = new_panels(11.0, 4.6, 1, 2, width_ratios=[1.5, 1])
    tidy_room(left, title=f"{views['ring'].nunique()} goals, {len(views):,} views at them")
    draw_surfaces(left, arena)
    poses, orientation = views[["x_m", "y_m", "heading_rad"]].to_numpy(), views["orientation_rad"].to_numpy()
    bare = {"width": 0.002, "headwidth": 0, "headlength": 0, "headaxislength": 0}
    draw_arrows(left, poses, length, color=direction_colours(orientation), **bare)
    frame_room(left, arena.bounds, 0.35)
    heading_bar(left)
    tidy(right, x="true heading (°)", y="orientation (°)", title="orientation passed from ring to ring")
    draw_agreement(right, poses[:, 2], orientation, views["ring"])
    return figure
