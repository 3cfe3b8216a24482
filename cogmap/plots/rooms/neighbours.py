"""Neighbours: views and the remembered views most like them (Table 3)."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, UInt8
from matplotlib.figure import Figure

from cogmap.errors import CogmapError
from cogmap.inputs import check_array
from cogmap.plots.style import BAD, INK, TINY, new_panels


def plot_neighbours(
    queries: UInt8[np.ndarray, "queries height width 3"],
    poses: Float[np.ndarray, "queries 3"],
    neighbours: UInt8[np.ndarray, "queries neighbours height width 3"],
    near: Float[np.ndarray, "queries neighbours 3"],
) -> Figure:
    """Draw each query (left, with its true pose in red) beside its neighbours, the nearest first.

    Parameters
    ----------
    queries, neighbours
        RGB images, row 0 on top.
    poses, near
        Where they were taken: (x, y, heading) in m and rad.

    Raises
    ------
    CogmapError
        For no queries, or poses that do not fit.
    """
    width = 12.0
    if neighbours.size == 0 or len(queries) != len(neighbours):
        raise CogmapError(
            f"{len(queries)} queries have {neighbours.shape[:2]} neighbours; give one row of them per query"
        )
    rows, columns = neighbours.shape[:2]
    check_array("poses", poses, (rows, 3))
    check_array("near", near.reshape(-1, 3), (rows * columns, 3))
    panel = (width - 0.4) / (columns + 1) * queries.shape[1] / queries.shape[2] + 0.32
    figure, grid = new_panels(width, max(2.0, rows * panel), rows, columns + 1, squeeze=False)
    for row, panels in enumerate(grid):
        images, said = [queries[row], *neighbours[row]], [poses[row], *near[row]]
        for column, (axes, image, pose) in enumerate(zip(panels, images, said, strict=True)):
            axes.imshow(image, interpolation="nearest")
            axes.set_axis_off()
            name = "query" if column == 0 else f"neighbour {column}"
            axes.set_title(f"{name}\n{_pose(pose)}", fontsize=TINY, color=BAD if column == 0 else INK)
    return figure


def _pose(pose: Float[np.ndarray, "3"]) -> str:
    x, y, heading = pose
    return f"{x:.2f} m, {y:.2f} m, {np.rad2deg(heading):.0f}°".replace("-", "−")
