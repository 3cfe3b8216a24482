"""Look-alikes: postures that differ, and the one image that shows both."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, UInt8
from matplotlib.figure import Figure

from cogmap.errors import CogmapError
from cogmap.plots.style import BAD, GOOD, new_panels, tidy, tidy_room


def plot_look_alikes(
    postures: Float[np.ndarray, "pairs 2 links 2 2"], views: UInt8[np.ndarray, "pairs 2 height width 3"]
) -> Figure:
    """Draw pairs of postures of an arm from above, each pair beside both of its views.

    Parameters
    ----------
    postures
        Ends of the links, m.
    views
        What is seen in each.

    Raises
    ------
    CogmapError
        Without a pair.
    """
    if not len(postures):
        raise CogmapError("there is no pair of postures to draw")
    figure, panels = new_panels(
        11.0, 3.0 * len(postures), len(postures), 3, width_ratios=[1, 1.6, 1.6], squeeze=False
    )
    for (above, *seen), pair, images in zip(panels, postures, views, strict=True):
        for links, colour in zip(pair, (GOOD, BAD), strict=True):
            points = np.vstack([links[0, 0], links[:, 1]])
            above.plot(*points.T, color=colour, linewidth=3, marker="o", markersize=5)
        tidy_room(above, title="two postures")
        for panel, image, name in zip(seen, images, ("blue", "red"), strict=True):
            panel.imshow(image, interpolation="nearest")
            tidy(panel, title=f"what the {name} one sees")
            panel.set(xticks=[], yticks=[])
    return figure
