"""Coordinates of a body: its views laid out by them, beside the same square coloured by the truth."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, UInt8
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.spatial import KDTree

from arena.bodies.base import Axis
from cogmap.errors import CogmapError
from cogmap.inputs import check_array
from cogmap.plots.style import (
    INK,
    QUARTERS,
    SMALL,
    colour_bar,
    direction_colours,
    heading_bar,
    new_panels,
    tidy,
)

MOSAIC = 6.0
"""Least width of the sheet of views, inches."""


def plot_coordinates(
    coordinates: Float[np.ndarray, "views coordinates"],
    names: Sequence[str],
    views: UInt8[np.ndarray, "views height width 3"],
    joints: Float[np.ndarray, "views joints"],
    axes: Sequence[Axis],
) -> Figure:
    """Lay views out by the first two coordinates, and draw these once for each joint, coloured by it.

    Where a sheet of views has a hole there was none near. With one coordinate the views lie along it, and
    below it stands the joint.

    Parameters
    ----------
    coordinates, names
        As `GeneralisedCoordinates` gives them: phases in rad, then heights.
    views
        What was seen.
    joints, axes
        The truth, and what each of its columns is.

    Raises
    ------
    CogmapError
        For arrays that do not fit each other, and no coordinates.
    """
    check_array("joints", joints, (len(views), len(axes)))
    check_array("coordinates", coordinates, (len(views), None))
    if len(names) != coordinates.shape[1]:
        raise CogmapError(f"there are {coordinates.shape[1]} coordinates but {len(names)} names; name each")
    drawn = coordinates[:, :2]
    if drawn.shape[1] == 1:
        drawn = np.column_stack([drawn, _for_people(joints[:, 0], axes[0])])
        names = [names[0], _label(axes[0])]
    phases = [name.startswith("phase") for name in names[:2]]
    figure, panels = new_panels(
        MOSAIC + 3.6 * len(axes), 5.0, 1, 1 + len(axes), width_ratios=[1.5] + [1] * len(axes), squeeze=False
    )
    limits = [(-np.pi, np.pi) if phase else _ends(part) for phase, part in zip(phases, drawn.T, strict=True)]
    _lay_out(panels[0, 0], drawn, views, limits)
    for panel, joint, axis in zip(panels[0, 1:], joints.T, axes, strict=True):
        circle = axis.kind == "circle"
        colours = direction_colours(joint) if circle else _for_people(joint, axis)
        dots = panel.scatter(*drawn.T, s=3, linewidths=0, c=colours)
        if circle:
            heading_bar(panel, _label(axis))
        else:
            dots.set_cmap("viridis")
            colour_bar(panel, dots, _label(axis))
    for panel, title in zip(panels[0], ["what is seen", *(axis.name for axis in axes)], strict=True):
        tidy(panel, x=_with_unit(names[0]), y=_with_unit(names[1]), title=title)
        panel.set(xlim=limits[0], ylim=limits[1])
        for phase, which in zip(phases, (panel.xaxis, panel.yaxis), strict=True):
            if phase:
                which.set_ticks(
                    np.deg2rad(QUARTERS), [f"{degrees}".replace("-", "−") for degrees in QUARTERS]
                )
        panel.set_box_aspect(1)
    figure.suptitle(
        f"{len(views):,} views by coordinates that were found in them alone", fontsize=SMALL, color=INK
    )
    return figure


def _lay_out(
    panel: Axes,
    drawn: Float[np.ndarray, "views 2"],
    views: UInt8[np.ndarray, "views height width 3"],
    limits: Sequence[tuple[float, float]],
) -> None:
    """Put at each place of a grid the view that is nearest to its middle, if there is one in it."""
    height, width = views.shape[1:3]
    columns = 9 if width <= 1.5 * height else 4
    rows = max(1, round(columns * width / height))
    (left, right), (low, high) = limits
    size = np.array([(right - left) / columns, (high - low) / rows])
    tree = KDTree(drawn / size)
    for column in range(columns):
        for row in range(rows):
            corner = np.array([left, low]) + [column, row] * size
            apart, nearest = tree.query(corner / size + 0.5)
            if apart <= 0.7:
                extent = (corner[0], corner[0] + 0.97 * size[0], corner[1], corner[1] + 0.97 * size[1])
                panel.imshow(views[nearest], extent=extent, aspect="auto", interpolation="nearest")


def _ends(values: Float[np.ndarray, " views"]) -> tuple[float, float]:
    margin = 0.02 * float(np.ptp(values))
    return float(values.min()) - margin, float(values.max()) + margin


def _for_people(joint: Float[np.ndarray, " views"], axis: Axis) -> Float[np.ndarray, " views"]:
    return np.rad2deg(joint) if axis.unit == "rad" else joint


def _label(axis: Axis) -> str:
    return f"{axis.name} ({'°' if axis.unit == 'rad' else axis.unit})"


def _with_unit(name: str) -> str:
    return f"{name} (°)" if name.startswith("phase") else name
