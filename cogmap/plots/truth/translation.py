"""Translation: height on a cylinder of views against the distance walked."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from matplotlib.figure import Figure

from cogmap.inputs import check_array
from cogmap.plots.style import direction_colours, heading_bar, new_panels, tidy


def plot_translation(
    height: Float[np.ndarray, "views"],
    along: Float[np.ndarray, "views"],
    headings: Float[np.ndarray, "views"],
) -> Figure:
    """Draw how high on their cylinder views are against how far along the way they were taken.

    Parameters
    ----------
    height
        From 0 at one end to 1 at the other.
    along
        m.
    headings
        rad; they give the colours.

    Raises
    ------
    CogmapError
        For values that are not finite or shapes that do not fit.
    """
    check_array("height", height, (None,))
    check_array("along", along, (len(height),))
    check_array("headings", headings, (len(height),))
    figure, axes = new_panels(6.0, 4.2)
    title = f"{len(height):,} views, R² = {np.corrcoef(height, along)[0, 1] ** 2:.3f}"
    tidy(axes, x="position along the way (m)", y="height on the cylinder (no unit)", title=title)
    axes.scatter(along, height, s=3, c=direction_colours(headings), linewidths=0)
    heading_bar(axes)
    return figure
