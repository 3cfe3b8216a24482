"""Afferent weights from charts to cells, drawn where the charts' own views were taken."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from matplotlib.figure import Figure

from cogmap.inputs import check_array
from cogmap.plots.style import colour_bar, draw_headings, heading_bar, new_panels, tidy, tidy_room


def plot_afferents(
    place: Float[np.ndarray, "charts place_cells"],
    heading: Float[np.ndarray, "charts heading_cells"],
    preferred: Float[np.ndarray, "charts 3"],
    *,
    count: int = 5,
) -> Figure:
    """Draw the weights of a few place cells and head-direction cells, a dot per chart.

    Above, charts lie where their preferred view was taken and are coloured by their weight to a place cell,
    the strongest on top. Below, their weight to a heading cell stands over the heading of that view.

    Parameters
    ----------
    place, heading
        Weights, Hz.
    preferred
        Pose of the view that each chart prefers: m, m, rad.
    count
        Cells of each population, evenly chosen.

    Raises
    ------
    CogmapError
        For values that are not finite or shapes that do not fit.
    """
    check_array("preferred", preferred, (None, 3))
    check_array("place", place, (len(preferred), None))
    check_array("heading", heading, (len(preferred), None))
    # Evenly chosen.
    places, directions = (np.unique(np.arange(count) * found.shape[1] // count) for found in (place, heading))
    figure, (above, below) = new_panels(13.0, 5.2, 2, count)
    strongest = max(float(place.max()), 1e-9)
    for axes, cell in zip(above, places, strict=False):
        order = np.argsort(place[:, cell])
        tidy_room(axes, title=f"place cell {cell}")
        x, y = preferred[order, :2].T
        weights = place[order, cell]
        drawn = axes.scatter(x, y, s=5, c=weights, cmap="viridis", vmin=0, vmax=strongest, linewidths=0)
    colour_bar(above[-1], drawn, "weight (Hz)")
    for axes, cell in zip(below, directions, strict=False):
        tidy(axes, x="heading of the chart's view (°)", y="weight (Hz)", title=f"head-direction cell {cell}")
        draw_headings(axes, preferred[:, 2], heading[:, cell], size=4.0, margin=0.0)
        axes.set_ylim(0, 1.05 * max(float(heading.max()), 1e-9))
    heading_bar(below[-1])
    return figure
