"""Routes planned among obstacles, from above (Fig. 7)."""

from __future__ import annotations

import numpy as np
import shapely
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from arena.bodies.disc import Disc
from arena.rooms.arena import Arena
from cogmap.inputs import check_array
from cogmap.plots.rooms.room import draw_arrows, draw_surfaces, frame_room
from cogmap.plots.style import BAD, GOOD, INK, new_panels, sheet_legend, tidy_room

MINE, THEIRS, START, GOAL = "visual roadmap", "OMPL's PRM", "start", "goal"


def plot_routes(
    arena: Arena,
    routes: list[tuple[Float[np.ndarray, "_ 3"], Float[np.ndarray, "_ 3"] | None]],
) -> Figure:
    """Draw each route in the room: poses of its views (arrows of 20 cm) and the peer's path (dashed).

    The shaded band is what the body sweeps; start is a circle, goal a square.

    Parameters
    ----------
    arena
        The room.
    routes
        Poses (x, y, heading) in m and rad of the visual roadmap and, if there is one, of the PRM.

    Raises
    ------
    CogmapError
        For poses that are not finite triples.
    """
    for mine, theirs in routes:
        for path in (mine, theirs):
            if path is not None:
                check_array("route", path, (None, 3))
    columns = min(3, max(1, len(routes)))
    rows = max(1, -(-len(routes) // columns))
    x0, y0, x1, y1 = arena.walkable.bounds
    width = 12.0 / columns
    height = rows * (width * (y1 - y0) / (x1 - x0) + 0.4) + 0.4
    figure, grid = new_panels(12.0, height, rows, columns, squeeze=False)
    for axes in grid.flat[len(routes) :]:
        axes.set_axis_off()
    for axes, (mine, theirs) in zip(grid.flat, routes, strict=False):
        tidy_room(axes, title=f"{len(mine) - 2} views on the way")
        draw_surfaces(axes, arena)
        for text in axes.texts:
            text.set_visible(False)
        _draw_route(axes, mine)
        if theirs is not None:
            axes.plot(*theirs[:, :2].T, "--", color=BAD, linewidth=1.3, zorder=8, label=THEIRS)
        frame_room(axes, arena.walkable.bounds, 0.1)
    if routes:
        drawn = [pair for axes in grid.flat for pair in zip(*axes.get_legend_handles_labels(), strict=True)]
        known = {label: handle for handle, label in drawn if label in (MINE, THEIRS, START, GOAL)}
        sheet_legend(figure, 4, handles=known.values(), labels=known.keys())
    return figure


def _draw_route(axes: Axes, path: Float[np.ndarray, "steps 3"]) -> None:
    swept = shapely.LineString(path[:, :2]).buffer(Disc().radius)
    outline = shapely.get_coordinates(swept.exterior)
    axes.add_patch(Polygon(outline, facecolor=GOOD, alpha=0.15, linewidth=0, zorder=1.5))
    axes.plot(*path[:, :2].T, color=GOOD, linewidth=1.3, zorder=8, label=MINE)
    draw_arrows(axes, path, 0.2, color=GOOD, width=0.005, zorder=8.5)
    for pose, mark, name in ((path[0], "o", START), (path[-1], "s", GOAL)):
        axes.plot(*pose[:2], mark, color=INK, markersize=7, zorder=9, label=name)
