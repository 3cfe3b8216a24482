"""A walk from above."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from arena.rooms.arena import Arena
from cogmap.inputs import check_array
from cogmap.plots.rooms.room import draw_surfaces, frame_room, height_of
from cogmap.plots.style import INK, colour_bar, direction_colours, heading_bar, new_panels, tidy_room


def plot_walk(
    arena: Arena, times: Float[np.ndarray, " views"], poses: Float[np.ndarray, "views 3"]
) -> Figure:
    """Draw a walk over its room, coloured by time and, beside it, by heading.

    The way from view to view is a line of the colour of its time, the first view a dot. At each view, or at
    up to 3,000 evenly chosen ones, a short stroke starts that points where the body looks.

    Parameters
    ----------
    arena
        The room.
    times
        s, in order.
    poses
        (x, y, heading) in m and rad.

    Raises
    ------
    CogmapError
        When `times` or `poses` is not a finite array of one row a view.
    """
    check_array("times", times, (None,))
    check_array("poses", poses, (len(times), 3))
    figure, (left, right) = new_panels(12.0, height_of(arena, 6.0), 1, 2)
    x0, y0, x1, y1 = arena.bounds
    extent = max(x1 - x0, y1 - y0)
    # Of more headings nothing could be seen.
    chosen = poses[:: -(-len(poses) // 3000)]
    titles = f"{arena.name}: the way of {len(poses):,} views", f"where it looks in {len(chosen):,} of them"
    for axes, title in zip((left, right), titles, strict=True):
        tidy_room(axes, title=title)
        draw_surfaces(axes, arena)
        frame_room(axes, arena.bounds, 0.06 * extent)
    clock = ScalarMappable(Normalize(times[0], times[-1]), colormaps["viridis"])
    ways = np.stack([poses[:-1, :2], poses[1:, :2]], axis=1)
    left.add_collection(
        LineCollection(list(ways), colors=clock.to_rgba(times[:-1]), linewidths=0.6, zorder=1)
    )
    left.plot(*poses[0, :2], "o", color=INK, markersize=4, zorder=2)
    colour_bar(left, clock, "time (s)")
    stroke = 0.02 * extent * np.stack([np.cos(chosen[:, 2]), np.sin(chosen[:, 2])], axis=1)
    strokes = np.stack([chosen[:, :2], chosen[:, :2] + stroke], axis=1)
    colours = direction_colours(chosen[:, 2])
    right.add_collection(LineCollection(list(strokes), colors=colours, linewidths=0.7, zorder=1))
    heading_bar(right)
    return figure
