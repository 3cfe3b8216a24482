"""Persistence barcodes: the loops and voids of clouds, and how far they stand out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cogmap.errors import CogmapError
from cogmap.plots.style import BAD, GOOD, INK, SMALL, SOFT, TINY, new_figure, plain_ticks, tidy
from cogmap.shape.homology import Betti


def plot_barcodes(results: Mapping[str, Betti], *, bars: int = 12) -> Figure:
    """Draw, for every result and dimension, the largest bars as π = death / birth against the threshold.

    One line of panels per result: loops (H₁) and voids (H₂). Bars that count are coloured; the dashed line is
    what a bar must exceed. Above each line stands what was found, and what of it is unresolved. The axes of a
    dimension are logarithmic and the same for all results.

    Parameters
    ----------
    results
        From `betti`, by the name of the cloud.
    bars
        How many of the largest are drawn in a panel.

    Raises
    ------
    CogmapError
        Without any result, and when none goes beyond pieces.
    """
    highest = max((len(result.numbers) - 1 for result in results.values()), default=0)
    if highest < 1:
        raise CogmapError(
            f"{len(results)} results and none has loops; give some of betti(X, max_dimension=1 or 2)"
        )
    figure = new_figure(10.0, 2.2 * len(results))
    lines = figure.subfigures(len(results), 1, squeeze=False, hspace=0.06)[:, 0]
    limits = [limit_of(results.values(), (dimension,)) for dimension in range(1, highest + 1)]
    for line, (name, result) in zip(lines, results.items(), strict=True):
        line.suptitle(f"{name}: {_summary(result)}", fontsize=SMALL + 1, color=INK)
        panels = line.subplots(1, highest, squeeze=False)[0]
        for dimension, (axes, limit) in enumerate(zip(panels, limits, strict=True), start=1):
            if dimension < len(result.numbers):
                _draw_bars(axes, result, dimension, limit, bars)
            else:
                axes.set_axis_off()
    return figure


def _summary(result: Betti) -> str:
    return ", ".join(
        f"b{dimension} = {number} ({votes} of {result.draws} draws" + (")" if resolved else ", unresolved)")
        for dimension, (number, votes, resolved) in enumerate(
            zip(result.numbers, result.votes, result.resolved, strict=True)
        )
    )


def limit_of(results: Iterable[Betti], dimensions: Iterable[int], least: float = 1.0) -> float:
    """Where an axis ends that holds all ratios and thresholds of these dimensions, the endless ones aside."""
    found = [
        np.append(result.ratios[dimension], result.thresholds[dimension])
        for result in results
        for dimension in dimensions
        if dimension < len(result.numbers)
    ]
    together = np.concatenate([*found, [least]])
    return 1.15 * float(together[np.isfinite(together)].max())


def draw_bars(axes: Axes, result: Betti, dimension: int, count: int, colour: str, *, first: int = 0) -> int:
    """Draw the largest bars as far as the axis reaches, those that count in this colour, and count them."""
    shown = np.minimum(result.ratios[dimension][:count], axes.get_xlim()[1])
    colours = [colour if rank < result.numbers[dimension] else SOFT for rank in range(len(shown))]
    axes.barh(first + np.arange(len(shown)), shown - 1, left=1, height=0.7, color=colours)
    return len(shown)


def _draw_bars(axes: Axes, result: Betti, dimension: int, limit: float, most: int) -> None:
    fine_ticks = (1.0, 1.1, 1.2, 1.3, 1.4, 1.6, 1.8, 2.0, 2.3)
    ticks = (1.0, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0)
    threshold, holes = result.thresholds[dimension], "loops" if dimension == 1 else "voids"
    tidy(axes, x=f"π of H{dimension} ({holes}), death / birth, no unit", y="bar, largest first")
    axes.set(xscale="log", xlim=(1, limit))
    shown = draw_bars(axes, result, dimension, most, GOOD)
    axes.axvline(threshold, color=BAD, linewidth=1.2, linestyle="--")
    said = f"threshold {threshold:.2f}"
    units: dict[str, Any] = {"xycoords": axes.get_xaxis_transform(), "textcoords": "offset points"}
    axes.annotate(said, (threshold, 1), (3, -2), va="top", fontsize=TINY, color=BAD, **units)
    plain_ticks(axes.xaxis, fine_ticks if limit < 2.5 else ticks)
    axes.set(ylim=(max(shown, 3) - 0.4, -1.6), yticks=[])
    if not shown:
        axes.text(0.5, 0.4, "no bars", transform=axes.transAxes, fontsize=SMALL, color=INK)
