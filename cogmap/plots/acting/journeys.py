"""Journeys to goals that are images, from above, and what is seen on the way of one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np
from jaxtyping import Float, UInt8
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure, SubFigure

from arena.acting import Journeys
from arena.eye.camera import Camera
from arena.rooms.arena import Arena
from cogmap.plots.rooms.room import draw_arrows, draw_surfaces, frame_room
from cogmap.plots.rooms.views import draw_panorama
from cogmap.plots.style import BAD, GOOD, INK, SMALL, SOFT, new_figure, sheet_legend, tidy, tidy_room

SHOWN = 24
"""Journeys that are drawn."""
FRAMES = 5
"""Views on the way of one."""


def plot_journeys(
    arena: Arena,
    gone: Journeys,
    goals: Float[np.ndarray, "pairs 3"] | None,
    images: UInt8[np.ndarray, "pairs height width 3"],
    camera: Camera,
) -> Figure:
    """Draw journeys over the room, one of them bold, and beside it what is seen on its way, and its goal.

    The bold one is that with the longest way. Circles are starts, arrows goals and where they look; steps
    that touched something are red.

    Parameters
    ----------
    arena, camera
        The room, and what sees it.
    gone
        The journeys.
    goals, images
        Poses (m and rad) of the goals, None where these are not known, and their images.
    """
    figure = new_figure(12.0, 5.2)
    left, right = cast("Sequence[SubFigure]", figure.subfigures(1, 2, width_ratios=[1.15, 1]))
    axes = left.subplots()
    many = f"{min(SHOWN, len(images))} of {len(images)} journeys to the pose of an image"
    tidy_room(axes, title=many if len(images) > 1 else "the journey to the pose of an image")
    draw_surfaces(axes, arena)
    for text in axes.texts:
        text.set_visible(False)
    ways = gone.poses[:, :, :2].transpose(1, 0, 2)
    lengths = np.linalg.norm(np.diff(ways, axis=1), axis=2).sum(axis=1)
    bold = int(lengths[:SHOWN].argmax())
    shown = [pair for pair in range(min(SHOWN, len(images))) if pair != bold]
    if shown:
        thin = LineCollection(list(ways[shown]), colors=SOFT, linewidths=0.9, zorder=6, label="way")
        axes.add_collection(thin)
        axes.plot(*gone.poses[0, shown, :2].T, "o", color=SOFT, markersize=3.5, zorder=7, label="start")
    axes.plot(*ways[bold].T, color=GOOD, linewidth=2.0, zorder=8, label="the way at the right")
    axes.plot(*ways[bold, 0], "o", color=GOOD, markersize=6, zorder=9)
    if goals is not None:
        if shown:
            draw_arrows(axes, goals[shown], 0.18, color=SOFT, width=0.004, zorder=7)
        draw_arrows(axes, goals[[bold]], 0.25, color=GOOD, width=0.008, zorder=9)
    _draw_contacts(axes, gone, [*shown, bold])
    frame_room(axes, arena.walkable.bounds, 0.15)
    sheet_legend(left, 4)
    steps = int(gone.steps[bold])
    frames = np.unique(np.linspace(0, steps, FRAMES).round().astype(int))
    seen = camera.model_copy(update={"noise": 0.0}).render(arena, gone.poses[frames, bold])
    panels = right.subplots(len(frames) + 1, 1)
    for panel, view, frame in zip(panels, seen, frames, strict=False):
        tidy(panel, title=f"seen after {gone.times[frame]:.1f} s", size=SMALL - 1)
        draw_panorama(panel, view)
        panel.tick_params(labelbottom=False)
    tidy(panels[-1], title="the image of the goal", size=SMALL - 1)
    draw_panorama(panels[-1], images[bold])
    right.supxlabel("azimuth (°)", fontsize=SMALL, color=INK)
    right.supylabel("elevation (°)", fontsize=SMALL, color=INK)
    return figure


def _draw_contacts(axes: Axes, gone: Journeys, pairs: list[int]) -> None:
    step, pair = np.nonzero(gone.touched[:, pairs])
    if len(step):
        at = gone.poses[step + 1, np.array(pairs)[pair], :2]
        axes.plot(*at.T, "x", color=BAD, markersize=5, zorder=10, label="contact")
