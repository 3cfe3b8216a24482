"""A contact sheet of a room as the animal sees it."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from matplotlib.figure import Figure

from arena.angles import wrap_angle
from arena.bodies.disc import Disc
from arena.eye.camera import Camera
from arena.rooms.arena import Arena
from cogmap.plots.rooms.views import WIDTH, draw_views, sheet_height
from cogmap.plots.style import INK, SMALL, new_figure
from cogmap.shape.rips import euclidean, farthest_points


def plot_sheet(arena: Arena, *, views: int = 6) -> Figure:
    """Draw perspective and panoramic views of a room, from the same places far from each other.

    Parameters
    ----------
    arena
        The room; the same room gives the same sheet.
    views
        How many of each kind.

    Raises
    ------
    ArenaError
        When the body fits nowhere.
    """
    poses = _spread(arena, views)
    ahead, around = (
        camera.render(arena, poses) for camera in (Camera.perspective(), Camera.panoramic(720, 120))
    )
    heights = sheet_height(ahead, 3), sheet_height(around, 2)
    figure = new_figure(WIDTH, sum(heights) + 0.3)
    figure.suptitle(arena.name, fontsize=SMALL, color=INK, parse_math=False)
    above, below = figure.subfigures(2, squeeze=False, height_ratios=heights).ravel()
    draw_views(above, ahead, poses, 3, panoramic=False)
    draw_views(below, around, poses, 2, panoramic=True)
    return figure


def _spread(arena: Arena, views: int) -> Float[np.ndarray, "views 3"]:
    # Free places among which those of the views are picked.
    xy = arena.sample_free(1000, Disc().radius, np.random.default_rng(0))
    taken = farthest_points(euclidean(xy), views, 0).indices
    # Headings a golden angle apart never repeat and soon point everywhere.
    headings = wrap_angle(np.pi * (3 - np.sqrt(5)) * np.arange(len(taken)))
    return np.column_stack([xy[taken], headings])
