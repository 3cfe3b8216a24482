"""The metric map, laid over the room."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from cogmap.cells.rates.bins import bin_edges, means_by_bin
from cogmap.inputs import check_array
from cogmap.plots.style import SOFT, new_panels, tidy, tidy_room
from cogmap.plots.truth.errors import draw_moves, draw_sizes


def plot_metric_map(mapped: Float[np.ndarray, "views 2"], true: Float[np.ndarray, "views 2"]) -> Figure:
    """Draw how the learnt map bends a square lattice of the room, and how far off it puts each view.

    Left the lattice of bins of 20 cm that were visited (grey), and the same lattice in the map: each node is
    moved by the mean error of the views in its bin, and has the colour of that distance. Right how many views
    are how far off; the last bin holds all that is beyond.

    Parameters
    ----------
    mapped
        Positions told by the map, laid in the room by one similarity, m.
    true
        In m.

    Raises
    ------
    CogmapError
        For values that are not finite or shapes that do not fit.
    """
    check_array("true", true, (None, 2))
    check_array("mapped", mapped, (len(true), 2))
    figure, (left, right) = new_panels(12.0, 4.6, 1, 2, width_ratios=[1.5, 1])
    away = mapped.astype(float) - true
    _draw_lattice(left, away, true)
    spread = np.square(true - true.mean(axis=0)).sum()
    explained = 1 - np.square(away).sum() / spread if spread else np.nan
    title = f"{len(true):,} views, R² {explained:.4f}"
    tidy(right, x="distance from the true position (cm)", y="views", title=title)
    draw_sizes(right, 100 * np.linalg.norm(away, axis=1), " cm", 2.0)
    return figure


def _draw_lattice(axes: Axes, away: Float[np.ndarray, "views 2"], true: Float[np.ndarray, "views 2"]) -> None:
    edges = bin_edges(true, 0.2)
    ny, nx = edges.shape
    mean = means_by_bin(edges.bin_of(true), ny * nx, away).reshape(ny, nx, 2)
    square = np.stack(np.meshgrid(*edges.centres), axis=2)
    square[np.isnan(mean[:, :, 0])] = np.nan
    moved = 100 * np.linalg.norm(mean, axis=2)
    tidy_room(axes, title="a square lattice of the room (grey), and where the map puts it")
    axes.add_collection(LineCollection(list(_links(square)), colors=SOFT, linewidths=0.5))
    ends = _links(square + mean)
    length = _links(np.repeat(moved[:, :, None], 2, axis=2))[:, :, 0].mean(axis=1)
    longest = float(np.nanpercentile(moved, 99))
    draw_moves(axes, ends, length, "mean error (cm)", longest=longest, width=1.6)


def _links(nodes: Float[np.ndarray, "ny nx 2"]) -> Float[np.ndarray, "links 2 2"]:
    """Give the ends of the links between neighbouring nodes, where both are finite."""
    across = np.stack([nodes[:, :-1], nodes[:, 1:]], axis=2).reshape(-1, 2, 2)
    along = np.stack([nodes[:-1], nodes[1:]], axis=2).reshape(-1, 2, 2)
    links = np.concatenate([across, along])
    finite: np.ndarray = links[np.isfinite(links).all(axis=(1, 2))]
    return finite
