"""The arena from above."""

from __future__ import annotations

import numpy as np
import shapely
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from arena.arena import Arena, Box, Pillar
from arena.materials import texture
from cogmap.cells.checks import check_array
from cogmap.plots.style import INK, SMALL, SOFT, direction_colours, new_figure, tidy_room

GRID = 0.04
"""Spacing in m of the points where the odour is asked for."""
HALVINGS = 7
"""Contours per odour at most."""
FIRST_VIEWS = 300
"""How much of the path is drawn as a line: of all of it nothing could be seen."""


def plot_room(arena: Arena, poses: Float[np.ndarray, "views 3"] | None = None) -> Figure:
    """Draw the arena from above: walls, boxes and pillars, platform, odours, and where views were taken.

    Solids have the mean colour of their material. The border of the platform is dashed. From one contour of
    an odour to the next outer one the concentration halves; all odours have the same levels. Every view is
    a dot, the way between the first 300 a line.

    Parameters
    ----------
    arena
        The room.
    poses
        (x, y, heading) in m and rad, (views, 3), in the order of the walk.

    Raises
    ------
    CogmapError
        When `poses` is not a finite (views, 3) array.
    """
    if poses is not None:
        check_array("poses", poses, (None, 3))
    x0, y0, x1, y1 = arena.bounds
    width = 8.0
    figure = new_figure(width, np.clip(width * (y1 - y0) / (x1 - x0) + 0.4, 2.0, 12.0))
    axes = figure.add_subplot()
    tidy_room(axes, title=f"{arena.name}: from one odour contour to the next the concentration halves")
    _draw_surfaces(axes, arena)
    _draw_odours(axes, arena)
    if poses is not None:
        _draw_path(axes, poses)
    margin = 0.03 * max(x1 - x0, y1 - y0)
    axes.set(xlim=(x0 - margin, x1 + margin), ylim=(y0 - margin, y1 + margin))
    figure.legend(loc="outside lower center", ncols=3, fontsize=SMALL, labelcolor=INK, frameon=False)
    return figure


def _colour(material: str) -> tuple[float, float, float]:
    red, green, blue = texture(material).mean(axis=(0, 1)) / 255
    return float(red), float(green), float(blue)


def _draw_surfaces(axes: Axes, arena: Arena) -> None:
    platform = shapely.union_all([shapely.Polygon(corners) for corners in arena.platform])
    for index, ring in enumerate(shapely.get_parts(platform.boundary)):
        axes.plot(*ring.xy, "--", color=INK, linewidth=1, zorder=3, label="platform" if index == 0 else None)
    solids: list[Box | Pillar] = [*arena.boxes, *arena.pillars]
    for solid in solids:
        axes.add_patch(
            Polygon(solid.outline, facecolor=_colour(solid.material), edgecolor=INK, linewidth=0.8, zorder=4)
        )
    for wall in arena.walls:
        x, y = np.transpose([wall.start, wall.end])
        axes.plot(x, y, color=INK, linewidth=6.5, solid_capstyle="projecting", zorder=5)
        axes.plot(x, y, color=_colour(wall.material), linewidth=5, solid_capstyle="projecting", zorder=5.1)


def _draw_odours(axes: Axes, arena: Arena) -> None:
    if not arena.sources:
        return
    x0, y0, x1, y1 = arena.bounds
    x, y = (np.linspace(a, b, 2 + int((b - a) / GRID)) for a, b in ((x0, x1), (y0, y1)))
    points = np.stack(np.meshgrid(x, y), axis=-1)
    odours = arena.odours.concentration(points.reshape(-1, 2)).reshape(*points.shape[:2], -1)
    highest = int(np.floor(np.log2(odours.max())))
    levels = 2.0 ** np.arange(highest - HALVINGS + 1, highest + 1)
    hues = direction_colours(2 * np.pi * np.arange(len(arena.sources)) / len(arena.sources))
    for index, (source, hue) in enumerate(zip(arena.sources, hues, strict=True)):
        odour = odours[..., index]
        reached = levels[(levels > odour.min()) & (levels < odour.max())]
        if len(reached):
            axes.contour(x, y, odour, reached, colors=[hue], linewidths=0.9, zorder=2)
        axes.plot(
            *source.position,
            "*",
            color=hue,
            markeredgecolor=INK,
            markeredgewidth=0.6,
            markersize=12,
            linestyle="none",
            zorder=6,
            label=f"odour source {index}",
        )


def _draw_path(axes: Axes, poses: Float[np.ndarray, "views 3"]) -> None:
    x, y = poses[:, :2].T
    axes.scatter(x, y, s=3.5, color=SOFT, alpha=0.7, linewidths=0, zorder=1, label=f"{len(poses):,} views")
    first = min(len(poses), FIRST_VIEWS)
    axes.plot(x[:first], y[:first], color=INK, linewidth=0.6, zorder=1.5, label=f"way of the first {first}")
