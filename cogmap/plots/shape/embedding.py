"""An embedding: views as points of a manifold."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from jaxtyping import Float
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure

from cogmap.errors import CogmapError
from cogmap.inputs import check_array
from cogmap.plots.style import INK, SMALL, TINY, colour_bar, direction_colours, heading_bar, new_panels, tidy


def plot_embedding(
    embedding: Float[np.ndarray, "views components"],
    headings: Float[np.ndarray, "views"],
    others: Mapping[str, Float[np.ndarray, "views"]] | None = None,
    *,
    coordinates: Sequence[int] = (0, 1, 2),
    most: int = 6000,
) -> Figure:
    """Draw two or three coordinates of the views, once coloured by heading and once by each of the others.

    Coordinates have the unit of the metric that they were found in, no unit for words.

    Parameters
    ----------
    embedding
        Coordinates.
    headings
        rad.
    others
        What else to colour by, under a name with its unit.
    coordinates
        Which two or three to draw.
    most
        Views that are drawn, evenly chosen; more than 6,000 would hide each other.

    Raises
    ------
    CogmapError
        For values that are not finite, shapes that do not fit, coordinates that do not exist.
    """
    # Room between axes and colour bar, as a share of the axes: a third axis has its label there.
    pads = {2: 0.02, 3: 0.14}
    check_array("embedding", embedding, (None, None))
    check_array("headings", headings, (len(embedding),))
    components = len(coordinates)
    if components not in {2, 3} or not all(0 <= item < embedding.shape[1] for item in coordinates):
        raise CogmapError(
            f"coordinates {tuple(coordinates)} of {embedding.shape[1]} cannot be drawn; choose two or three"
        )
    others = others or {}
    for name, values in others.items():
        check_array(name, values, (len(embedding),))
    chosen = np.linspace(0, len(embedding) - 1, min(len(embedding), most)).astype(int)
    kind = {"projection": "3d"} if components == 3 else {}
    columns = 1 + len(others)
    figure, (panels,) = new_panels(5.2 * columns, 4.6, 1, columns, squeeze=False, subplot_kw=kind)
    points = embedding[chosen][:, list(coordinates)].T
    names = [f"coordinate {item + 1} (no unit)" for item in coordinates]
    _draw(panels[0], points, names, direction_colours(headings[chosen]))
    heading_bar(panels[0], pad=pads[components])
    for axes, (name, values) in zip(panels[1:], others.items(), strict=True):
        drawn = _draw(axes, points, names, values[chosen])
        colour_bar(axes, drawn, name, pad=pads[components])
    figure.suptitle(f"{len(embedding):,} views on their manifold", fontsize=SMALL, color=INK)
    return figure


def _draw(axes: Any, points: np.ndarray, names: list[str], colours: np.ndarray) -> PathCollection:
    """Scatter points in a plane or, where the axes have three dimensions, in space."""
    tidy(axes, x=names[0], y=names[1])
    if len(points) == 3:
        axes.set_zlabel(names[2], fontsize=SMALL, color=INK)
        axes.tick_params(axis="z", labelsize=TINY, colors=INK)
        axes.set_box_aspect(np.ptp(points, axis=1))
        axes.view_init(elev=28, azim=-60)
    else:
        axes.set_aspect("equal")
    drawn: PathCollection = axes.scatter(*points, s=3.0, c=colours, linewidths=0)
    drawn.set_cmap("viridis")
    return drawn
