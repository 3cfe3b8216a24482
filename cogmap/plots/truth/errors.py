"""Errors: estimates against the truth, how many are how far off, and where in the room."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from numpy.typing import ArrayLike

from arena.angles import wrap_angle
from cogmap.plots.style import BAD, GOOD, SOFT, colour_bar, tidy_legend


def draw_agreement(
    axes: Axes, true: Float[np.ndarray, "views"], found: Float[np.ndarray, "views"], colours: ArrayLike
) -> None:
    """Draw angles (rad) against what they should be, in degrees, with the line where they are equal."""
    x, y = (np.rad2deg(wrap_angle(angles.astype(float))) for angles in (true, found))
    axes.plot([-180, 180], [-180, 180], color=SOFT, linewidth=0.6)
    axes.scatter(x, y, s=4, c=colours, linewidths=0).set_cmap("viridis")
    axes.set(xlim=(-185, 185), ylim=(-185, 185), aspect="equal")


def draw_sizes(axes: Axes, sizes: Float[np.ndarray, "views"], unit: str, reach: float) -> None:
    """Count errors by size, up to `reach` times what 95 % are below; the last bin holds what is beyond."""
    median, most = np.percentile(sizes, [50, 95])
    limit = max(reach * float(most), 1e-3)
    beyond = int(np.count_nonzero(sizes > limit))
    axes.hist(np.minimum(sizes, limit), bins=np.linspace(0, limit, 46).tolist(), color=SOFT)
    axes.axvline(median, color=GOOD, linewidth=1.4, label=f"median {median:.1f}{unit}")
    axes.axvline(most, color=BAD, linewidth=1.4, linestyle="--", label=f"95 % below {most:.1f}{unit}")
    axes.set_xlim(0, limit)
    tidy_legend(axes, title=f"{beyond} beyond {limit:.0f}{unit}, in the last bin" if beyond else "")


def draw_moves(
    axes: Axes,
    ends: Float[np.ndarray, "lines 2 2"],
    away: Float[np.ndarray, "lines"],
    label: str,
    *,
    longest: float,
    width: float,
) -> None:
    """Draw lines in the colour of how far (cm) they are off; `longest` and beyond have the same colour."""
    scale = Normalize(0, max(longest, 1e-3))
    lines = LineCollection(list(ends), array=away, cmap="viridis_r", norm=scale, linewidths=width)
    axes.add_collection(lines)
    axes.autoscale_view()
    colour_bar(axes, lines, label, extend="max")
