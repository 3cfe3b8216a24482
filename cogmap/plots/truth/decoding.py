"""Decoding of a session: where its cells say that the animal was and faced, against the truth."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cogmap.cells.sessions.decoding import Decoded
from cogmap.plots.style import (
    GOOD,
    INK,
    QUARTERS,
    SOFT,
    direction_colours,
    new_panels,
    tidy,
    tidy_legend,
    tidy_room,
)
from cogmap.plots.truth.errors import draw_agreement, draw_moves


def plot_decoding(decoded: Decoded) -> Figure:
    """Draw decoded against true positions, how far they are apart, and decoded against true headings.

    Left a segment from the true position (dot) to the decoded one, for at most 800 windows evenly chosen; in
    the middle the share of windows whose error is below so many cm, grey for a decoder that knows nothing of
    now; right each window by its headings, where these are known.

    Parameters
    ----------
    decoded
        From `decode_session`.
    """
    widths = [1.3, 1.0] if decoded.headings is None else [1.3, 1.0, 1.0]
    figure, panels = new_panels(3.7 * sum(widths), 3.8, 1, len(widths), width_ratios=widths)
    left, middle, *right = panels
    _draw_room(left, decoded)
    away = 100 * np.linalg.norm(decoded.decoded_positions - decoded.positions, axis=1)
    lost = 100 * np.linalg.norm(decoded.shuffled_positions - decoded.positions, axis=1)
    tidy(middle, x="position error (cm)", y="share of windows", title=f"{len(away):,} windows")
    for name, error, colour in (("cells", away, GOOD), ("chance", lost, SOFT)):
        middle.ecdf(error, color=colour, linewidth=1.6, label=f"{name}: median {np.median(error):.1f} cm")
    middle.set(xlim=(0, max(float(np.percentile(lost, 95)), 1e-3)), ylim=(0, 1.01))
    tidy_legend(middle, loc="lower right")
    if right and decoded.headings is not None and decoded.decoded_headings is not None:
        figures = decoded.figures
        told = f"median error {figures['heading_median_deg']:.1f}°"
        tidy(right[0], x="true heading (°)", y="decoded heading (°)", title=told)
        draw_agreement(
            right[0], decoded.headings, decoded.decoded_headings, direction_colours(decoded.decoded_headings)
        )
        right[0].set(xticks=QUARTERS, yticks=QUARTERS)
    return figure


def _draw_room(axes: Axes, decoded: Decoded) -> None:
    # More would hide each other.
    count = min(len(decoded.positions), 800)
    chosen = np.arange(count) * len(decoded.positions) // count
    true: Float[np.ndarray, "lines 2"] = decoded.positions[chosen]
    ends = np.stack([true, decoded.decoded_positions[chosen]], axis=1)
    length = 100 * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    tidy_room(axes, title=f"true (dot) to decoded position, {count:,} windows")
    axes.scatter(true[:, 0], true[:, 1], s=2.5, color=INK, linewidths=0, zorder=3)
    draw_moves(axes, ends, length, "position error (cm)", longest=float(np.percentile(length, 99)), width=0.9)
