"""Position errors: how well the recalled odour tells the place."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cogmap.inputs import check_array
from cogmap.plots.style import BAD, GOOD, INK, SOFT, new_panels, tidy, tidy_legend, tidy_room
from cogmap.plots.truth.errors import draw_moves


def plot_position(
    recalled: Float[np.ndarray, "views 2"],
    true: Float[np.ndarray, "views 2"],
    nose: Float[np.ndarray, "views 2"] | None = None,
) -> Figure:
    """Draw recalled against true positions in the room, and how the errors are distributed.

    Left a segment from the true position (dot) to the recalled one, for at most 1500 views evenly chosen;
    right the share of all views whose error is below so many cm.

    Parameters
    ----------
    recalled
        Decoded from the odour recalled from sight, m.
    true
        In m.
    nose
        Decoded in the same way from the odour smelt, m.

    Raises
    ------
    CogmapError
        For values that are not finite or shapes that do not fit.
    """
    check_array("true", true, (None, 2))
    check_array("recalled", recalled, (len(true), 2))
    if nose is not None:
        check_array("nose", nose, (len(true), 2))
    figure, (left, right) = new_panels(12.0, 4.6, 1, 2, width_ratios=[1.5, 1])
    _draw_room(left, recalled, true)
    tidy(right, x="position error (cm)", y="share of views", title=f"{len(true):,} views")
    worst = 1e-3
    for name, found, colour in (("recalled from sight", recalled, GOOD), ("raw nose", nose, BAD)):
        if found is not None:
            error = 100 * np.linalg.norm(found - true, axis=1)
            median, most = np.percentile(error, [50, 95])
            said = f"{name}: median {median:.1f} cm, 95 % below {most:.1f} cm"
            right.ecdf(error, color=colour, linewidth=1.6, label=said)
            right.plot([median, most], [0.5, 0.95], "o", color=colour, markersize=4)
            worst = max(worst, 1.3 * float(most))
    right.axhline(0.95, color=SOFT, linewidth=0.6, linestyle=":")
    right.axhline(0.5, color=SOFT, linewidth=0.6, linestyle=":")
    right.set(xlim=(0, worst), ylim=(0, 1.01))
    tidy_legend(right, loc="lower right")
    return figure


def _draw_room(
    axes: Axes, recalled: Float[np.ndarray, "views 2"], true: Float[np.ndarray, "views 2"]
) -> None:
    # More would hide each other.
    count = min(len(true), 1500)
    chosen = np.arange(count) * len(true) // count
    ends = np.stack([true[chosen], recalled[chosen]], axis=1)
    length = 100 * np.linalg.norm(recalled[chosen] - true[chosen], axis=1)
    tidy_room(axes, title=f"true (dot) to recalled position, {count:,} of {len(true):,} views")
    axes.scatter(true[chosen, 0], true[chosen, 1], s=2.5, color=INK, linewidths=0, zorder=3)
    longest = float(np.percentile(length, 99))
    draw_moves(axes, ends, length, "position error (cm)", longest=longest, width=0.9)
