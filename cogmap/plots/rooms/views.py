"""Views: what the eye saw, in rows."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, UInt8
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from cogmap.errors import CogmapError
from cogmap.inputs import check_array
from cogmap.plots.style import INK, QUARTERS, SMALL, new_figure, tidy

WIDTH = 12.0


def plot_views(
    views: UInt8[np.ndarray, "views height width 3"],
    poses: Float[np.ndarray, "views 3"] | None = None,
    columns: int = 3,
    *,
    panoramic: bool = True,
) -> Figure:
    """Draw every one of a handful of views, with the pose it was taken from.

    A panorama has the azimuth in degrees along x, from 180 (straight back, over the left shoulder) through 0
    (ahead) to −180, and the elevation e at (180 / π) tan e along y: its pixels are square, its rows equal
    steps on a cylinder.

    Parameters
    ----------
    views
        RGB images, row 0 on top.
    poses
        (x, y, heading) in m and rad.
    columns
        Of the sheet.
    panoramic
        Whether the views go all around; otherwise the axes count pixels.

    Raises
    ------
    CogmapError
        For no views, poses that do not fit them, fewer than one column.
    """
    count = len(views)
    if count == 0 or columns < 1:
        raise CogmapError(f"{count} views in {columns} columns; give at least one of each")
    if poses is not None:
        check_array("poses", poses, (count, 3))
    figure = new_figure(WIDTH, max(2.0, sheet_height(views, columns)))
    draw_views(figure, views, poses, columns, panoramic=panoramic)
    return figure


def sheet_height(views: UInt8[np.ndarray, "views height width 3"], columns: int) -> float:
    """How high a sheet of these views, `WIDTH` inches wide, must be, in inches."""
    count, rows, width, _ = views.shape
    columns = min(columns, count)
    panel = (WIDTH - 0.6) / columns * rows / width + 0.28
    return float(-(-count // columns) * panel + 0.6)


def draw_views(
    figure: Figure | SubFigure,
    views: UInt8[np.ndarray, "views height width 3"],
    poses: Float[np.ndarray, "views 3"] | None,
    columns: int,
    *,
    panoramic: bool,
) -> None:
    """Fill a figure or a part of one with views; see `plot_views`."""
    count = len(views)
    columns = min(columns, count)
    grid = figure.subplots(-(-count // columns), columns, squeeze=False, sharex=True, sharey=True)
    for index, axes in enumerate(grid.ravel()):
        if index >= count:
            axes.set_axis_off()
            continue
        tidy(axes, title="" if poses is None else _pose(poses[index]))
        axes.title.set_fontsize(SMALL - 1)
        if panoramic:
            draw_panorama(axes, views[index])
        else:
            axes.imshow(views[index], interpolation="nearest")
        axes.tick_params(labelbottom=index + columns >= count, labelleft=index % columns == 0)
    figure.supxlabel("azimuth (°)" if panoramic else "column (pixels)", fontsize=SMALL, color=INK)
    figure.supylabel("elevation (°)" if panoramic else "row (pixels)", fontsize=SMALL, color=INK)


def draw_panorama(axes: Axes, view: UInt8[np.ndarray, "height width 3"]) -> None:
    """Draw a panorama with its azimuth and elevation in degrees."""
    # Ticks in degrees above the horizon.
    elevations = np.array([-60, -40, -20, 0, 20, 40, 60])
    half = 180 * view.shape[0] / view.shape[1]
    axes.imshow(view, interpolation="nearest", extent=(180, -180, -half, half))
    axes.set_xticks(QUARTERS)
    heights = np.rad2deg(np.tan(np.deg2rad(elevations)))
    shown = np.abs(heights) <= half
    axes.set_yticks(heights[shown], [f"{elevation}".replace("-", "−") for elevation in elevations[shown]])


def _pose(pose: Float[np.ndarray, " 3"]) -> str:
    x, y, heading = pose
    return f"x {x:.2f} m, y {y:.2f} m, heading {np.rad2deg(heading):.0f}°".replace("-", "−")
