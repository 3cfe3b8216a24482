"""A reach: a film strip of what an arm sees on its way to the posture of an image, and the way."""

from __future__ import annotations

from typing import Any

import numpy as np
from jaxtyping import Float, Int, UInt8
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from arena.angles import wrap_angle
from arena.bodies.base import Body
from arena.rooms.arena import Arena
from cogmap.plots.rooms.room import draw_surfaces, frame_room
from cogmap.plots.style import ABSENT, GOOD, INK, QUARTERS, SMALL, new_figure, tidy, tidy_room

CELLS = 180
"""Of the square of joints, a turn."""


def plot_joint_reach(
    arena: Arena,
    body: Body,
    way: Float[np.ndarray, "looks 2"],
    *,
    frames: Int[np.ndarray, " frames"],
    views: UInt8[np.ndarray, "frames height width 3"],
    goal: UInt8[np.ndarray, "height width 3"],
) -> Figure:
    """Draw views on the way of an arm beside that of its goal, the arm from above, and the way of its joints.

    Parameters
    ----------
    arena, body
        The room and the arm.
    way
        Its two joints at each look, rad.
    frames, views
        At which looks it is drawn, and what it saw there.
    goal
        The image that it is to see.
    """
    shape = views.shape[1] / views.shape[2]
    rows = 2 if shape < 0.5 else 1
    columns = -(-(len(frames) + 1) // rows)
    strip = rows * (12.0 / columns * shape + 0.35)
    figure = new_figure(12.0, strip + 5.2)
    parts: Any = figure.subfigures(2, 1, height_ratios=[strip, 5.2])
    panels = parts[0].subplots(rows, columns, squeeze=False).ravel()
    colours = colormaps["viridis"](np.linspace(0, 0.9, len(frames)))
    for panel in panels:
        panel.set_axis_off()
    for number, (panel, view) in enumerate(zip(panels, views, strict=False), 1):
        panel.imshow(view, interpolation="nearest")
        panel.set_title(f"{number}", fontsize=SMALL, color=colours[number - 1])
    panels[len(frames)].imshow(goal, interpolation="nearest")
    panels[len(frames)].set_title("goal", fontsize=SMALL, color=INK)
    above, square = parts[1].subplots(1, 2)
    _draw_arm(above, arena, body, way[frames], colours)
    _draw_torus(square, arena, body, way)
    for number, (joints, colour) in enumerate(zip(np.rad2deg(way[frames]), colours, strict=True), 1):
        square.plot(*joints, "o", color=colour, markersize=8, zorder=5)
        square.annotate(
            f"{number}", joints, (6, 5), textcoords="offset points", fontsize=SMALL, color=INK, zorder=6
        )
    return figure


def _draw_arm(
    axes: Axes, arena: Arena, body: Body, postures: Float[np.ndarray, "frames 2"], colours: np.ndarray
) -> None:
    tidy_room(axes, title="from above")
    draw_surfaces(axes, arena)
    for text in axes.texts:
        text.set_visible(False)
    segments = body.segments(postures)
    for links, colour in zip(segments, colours, strict=True):
        axes.plot(*np.vstack([links[0, 0], links[:, 1]]).T, color=colour, linewidth=4, alpha=0.85, zorder=8)
    reach = np.abs(segments - segments[0, 0, 0]).max() * 1.2
    x, y = segments[0, 0, 0]
    frame_room(axes, (x - reach, y - reach, x + reach, y + reach), 0.0)


def _draw_torus(axes: Axes, arena: Arena, body: Body, way: Float[np.ndarray, "looks 2"]) -> None:
    """Draw the square of both joints whose opposite sides are one, grey where the arm cannot be."""
    angles = -np.pi + 2 * np.pi * (np.arange(CELLS) + 0.5) / CELLS
    grid = np.stack(np.meshgrid(angles, angles), axis=-1)
    free = body.is_free(arena, grid.reshape(-1, 2)).reshape(CELLS, CELLS)
    shade = np.ma.masked_array(np.ones(free.shape), free)
    axes.imshow(shade, origin="lower", extent=(-180, 180, -180, 180), cmap=colormaps["Greys"], vmin=0, vmax=4)
    # unrolled, and drawn once for each copy of the square that it passes through
    unrolled = np.rad2deg(
        way[0] + np.vstack([np.zeros(2), np.cumsum(wrap_angle(np.diff(way, axis=0)), axis=0)])
    )
    turns = np.unique(np.round(unrolled / 360).astype(int), axis=0)
    for turn in turns:
        axes.plot(*(unrolled - 360 * turn).T, color=GOOD, linewidth=1.6, zorder=4)
    names = [body.axes[k].name.replace("_", " ") for k in range(2)]
    tidy(axes, x=f"{names[0]} (°)", y=f"{names[1]} (°)", title="the square of its joints; grey: blocked")
    axes.set(xlim=(-180, 180), ylim=(-180, 180), xticks=QUARTERS, yticks=QUARTERS, facecolor="white")
    axes.set_box_aspect(1)
    axes.spines[:].set_color(ABSENT)
