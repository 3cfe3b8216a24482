"""The room from above."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.patheffects import withStroke
from shapely.geometry.base import BaseGeometry

from arena.rooms.arena import Arena
from arena.rooms.light import Light
from arena.rooms.materials import texture
from arena.rooms.parts import Solid, Wall
from arena.smell.odour import FAINTEST
from cogmap.inputs import check_array
from cogmap.plots.style import INK, SOFT, TINY, direction_colours, new_panels, sheet_legend, tidy_room


def plot_room(arena: Arena, poses: Float[np.ndarray, "views 3"] | None = None) -> Figure:
    """Draw the arena from above: walls, solids, platform, odours, light, and where views were taken.

    Walls, solids and their sides have the mean colour of their material, whose name and height stand beside
    or on them. The border of the platform is dashed. From one contour of an odour to the next outer one the
    concentration halves; all odours have the same levels. Every view is a dot, the way between the first 300
    a line.

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
    ArenaError
        For odours that the room's grid cannot resolve.
    """
    if poses is not None:
        check_array("poses", poses, (None, 3))
    figure, axes = new_panels(8.0, height_of(arena, 8.0 if arena.light is None else 7.0))
    tidy_room(axes, title=f"{arena.name}: from one odour contour to the next the concentration halves")
    axes.title.set_parse_math(False)
    draw_surfaces(axes, arena)
    _draw_odours(axes, arena)
    if arena.light is not None:
        _draw_light(axes, arena.light)
    if poses is not None:
        _draw_path(axes, poses)
    x0, y0, x1, y1 = arena.bounds
    frame_room(axes, arena.bounds, 0.05 * max(x1 - x0, y1 - y0))
    sheet_legend(figure, 5)
    return figure


def height_of(arena: Arena, width: float) -> float:
    """How high a figure must be for a plan of this width, in inches."""
    x0, y0, x1, y1 = arena.bounds
    return float(np.clip(width * (y1 - y0) / (x1 - x0) + 0.4, 2.0, 12.0))


def frame_room(axes: Axes, bounds: tuple[float, float, float, float], margin: float) -> None:
    """Show what is within bounds (x0, y0, x1, y1) and a margin around them, m."""
    x0, y0, x1, y1 = bounds
    axes.set(xlim=(x0 - margin, x1 + margin), ylim=(y0 - margin, y1 + margin))


def draw_arrows(axes: Axes, poses: Float[np.ndarray, "views 3"], length: float, **look: Any) -> None:
    """Draw an arrow of this length (m) from each pose to where the body looks."""
    x, y, heading = poses.T
    u, v = length * np.cos(heading), length * np.sin(heading)
    axes.quiver(x, y, u, v, angles="xy", scale_units="xy", scale=1, **look)


def draw_surfaces(axes: Axes, arena: Arena) -> None:
    """Draw the border of the platform, the walls and the solids."""
    _draw_platform(axes, arena)
    for wall in arena.walls:
        _draw_wall(axes, wall, arena.walkable)
    for solid in arena.solids:
        _draw_solid(axes, solid)


def _colour(material: str) -> tuple[float, float, float]:
    red, green, blue = texture(material).mean(axis=(0, 1)) / 255
    return float(red), float(green), float(blue)


def _draw_platform(axes: Axes, arena: Arena) -> None:
    for index, ring in enumerate(shapely.get_parts(arena.walkable.boundary)):
        axes.plot(*ring.xy, "--", color=INK, linewidth=1, zorder=3, label="platform" if index == 0 else None)
    if isinstance(arena.floor, str):
        axes.plot(
            [], [], "s", color=_colour(arena.floor), markeredgecolor=INK, label=f"floor of {arena.floor}"
        )


def _draw_wall(axes: Axes, wall: Wall, walkable: BaseGeometry) -> None:
    ends = np.array([wall.start, wall.end])
    axes.plot(*ends.T, color=INK, linewidth=6.5, solid_capstyle="projecting", zorder=5)
    axes.plot(*ends.T, color=_colour(wall.material), linewidth=5, solid_capstyle="projecting", zorder=5.1)
    along = np.subtract(wall.end, wall.start)
    normal = np.array([along[1], -along[0]]) / np.hypot(*along)
    aside = shapely.points(ends.mean(axis=0) + np.outer([0.1, -0.1], normal))
    outward = normal if np.diff(shapely.distance(walkable, aside)) <= 0 else -normal
    _name_side(axes, ends, outward, f"{wall.material}, {wall.height:g} m")


def _draw_solid(axes: Axes, solid: Solid) -> None:
    top_colour = _colour(solid.sides[0])
    axes.add_patch(Polygon(solid.outline, facecolor=top_colour, edgecolor=INK, linewidth=0.8, zorder=4))
    said = f"{solid.height:g} m"
    if len(set(solid.sides)) == 1:
        said = f"{solid.sides[0]}\n{said}"
    else:
        sides = np.stack([solid.outline, np.roll(solid.outline, -1, axis=0)], axis=1)
        for side, name in zip(sides, solid.sides, strict=True):
            axes.plot(*side.T, color=_colour(name), linewidth=3, zorder=4.1)
            along = side[1] - side[0]
            # A shorter side has no room for a name.
            if np.hypot(*along) >= 0.5:
                _name_side(axes, side, np.array([along[1], -along[0]]) / np.hypot(*along), name)
    width, depth = np.ptp(solid.outline, axis=0)
    middle = shapely.Polygon(solid.outline).representative_point()
    written = axes.text(middle.x, middle.y, said, ha="center", va="center", fontsize=TINY, clip_on=True)
    written.set(rotation=90 if depth > width else 0, zorder=7)
    written.set_color("white" if np.dot(top_colour, (0.3, 0.6, 0.1)) < 0.5 else INK)
    written.set_path_effects([withStroke(linewidth=2, foreground=top_colour)])


def _name_side(
    axes: Axes, ends: Float[np.ndarray, "2 2"], outward: Float[np.ndarray, " 2"], said: str
) -> None:
    """Write along a side, on the side that `outward` points to."""
    dx, dy = ends[1] - ends[0]
    # Never upside down.
    turn = np.rad2deg(np.arctan2(dy, dx)) % 180
    middle, away = tuple(ends.mean(axis=0).tolist()), tuple((10 * outward).tolist())
    written = axes.annotate(said, middle, away, textcoords="offset points", fontsize=TINY, color=INK)
    written.set(rotation=turn - 180 if turn > 90.5 else turn, rotation_mode="anchor", zorder=7)
    written.set(ha="center", va="center_baseline")


def _draw_light(axes: Axes, light: Light) -> None:
    # Right of the room.
    beside = (1.07, 0.8)
    across, up = (light.direction[:2] / np.hypot(*light.direction[:2])).tolist()
    units: dict[str, Any] = {"xycoords": "axes fraction", "textcoords": "offset points"}
    axes.annotate("", beside, (40 * across, 40 * up), arrowprops={"arrowstyle": "-|>", "color": INK}, **units)
    said = f"light from {light.azimuth_deg:g}°,\n{light.elevation_deg:g}° up,\nstrength {light.strength:g}"
    said = said.replace("-", "−")
    away, end = (-8, "top") if up > 0 else (8, "bottom")
    axes.annotate(said, beside, (0, away), ha="center", va=end, fontsize=TINY, color=INK, **units)


def _draw_odours(axes: Axes, arena: Arena) -> None:
    if not arena.sources:
        return
    x0, y0, x1, y1 = arena.bounds
    # The odour is asked for every 4 cm, at 500 points at most along either axis.
    x, y = (np.linspace(a, b, min(2 + int((b - a) / 0.04), 500)) for a, b in ((x0, x1), (y0, y1)))
    points = np.stack(np.meshgrid(x, y), axis=-1)
    odours = arena.odours.concentration(points.reshape(-1, 2)).reshape(*points.shape[:2], -1)
    # Where none arrives there is nothing to draw, and no way from the least to nothing.
    odours[odours <= FAINTEST * 1.01] = np.nan
    highest = int(np.floor(np.log2(np.nanmax(odours))))
    # At most seven contours an odour can be told apart.
    levels = 2.0 ** np.arange(highest - 7 + 1, highest + 1)
    hues = direction_colours(2 * np.pi * np.arange(len(arena.sources)) / len(arena.sources))
    for index, (source, hue) in enumerate(zip(arena.sources, hues, strict=True)):
        odour = odours[..., index]
        reached = levels[(levels > np.nanmin(odour)) & (levels < np.nanmax(odour))]
        if len(reached):
            axes.contour(x, y, odour, reached, colors=[hue], linewidths=0.9, zorder=2)
        name = f"odour source {index}"
        (star,) = axes.plot(*source.position, "*", color=hue, markersize=12, zorder=6, label=name)
        star.set(markeredgecolor=INK, markeredgewidth=0.6)


def _draw_path(axes: Axes, poses: Float[np.ndarray, "views 3"]) -> None:
    x, y = poses[:, :2].T
    axes.scatter(x, y, s=3.5, color=SOFT, alpha=0.7, linewidths=0, zorder=1, label=f"{len(poses):,} views")
    # Of a line through all views nothing could be seen.
    first = min(len(poses), 300)
    axes.plot(x[:first], y[:first], color=INK, linewidth=0.6, zorder=1.5, label=f"way of the first {first}")
