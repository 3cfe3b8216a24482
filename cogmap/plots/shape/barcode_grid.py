"""Barcodes of many clouds at a glance: loops and voids, a line per room, a column per cloud."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter

from cogmap.errors import CogmapError
from cogmap.plots.style import BAD, GOOD, INK, SMALL, SOFT, new_figure, tidy
from cogmap.shape.homology import Betti

LOOPS, VOIDS = 6, 4
"""The largest that are drawn."""


def plot_barcode_grid(
    results: Mapping[str, Mapping[str, Betti | None]], expected: Mapping[str, Mapping[str, tuple[int, ...]]]
) -> Figure:
    """Draw the largest loops and voids of every cloud as π = death / birth, a line of panels per room.

    Loops stand above voids. Bars that count are coloured, and the dashed line across them is what they must
    exceed. The title of a panel tells the numbers found; where they are not as expected it is red and tells
    those too. The panels of a column share their logarithmic axis.

    Parameters
    ----------
    results
        From `betti`, by room and by the name of the cloud; None where there was no cloud.
    expected
        Betti numbers of the same rooms and clouds, as many as are known.

    Raises
    ------
    CogmapError
        Without any cloud, and for rooms or clouds that are not the same in both.
    """
    # Of a panel, in inches.
    width, height = 2.5, 1.45
    clouds = list(next(iter(results.values()), {}))
    shapes = {room: list(found) for room, found in results.items()}
    if not clouds or any(list(known) != clouds for known in (*results.values(), *expected.values())):
        raise CogmapError(f"the rooms have the clouds {shapes}; give each room the same, and at least one")
    if list(results) != list(expected):
        raise CogmapError(f"results of {list(results)}, expected of {list(expected)}; give the same rooms")
    figure = new_figure(width * len(clouds) + 0.5, height * len(results) + 0.9)
    panels = figure.subplots(len(results), len(clouds), squeeze=False)
    for column, name in zip(panels.T, clouds, strict=True):
        limit = _limit([results[room][name] for room in results])
        for axes, room in zip(column, results, strict=True):
            title = _draw(axes, results[room][name], expected[room][name], limit)
            title = f"{name.replace('_', ' ')}\n{title}" if axes is column[0] else title
            axes.set_title(title, fontsize=SMALL)
        column[-1].set_xlabel("π = death / birth, no unit", fontsize=SMALL, color=INK)
    for axes, room in zip(panels[:, 0], results, strict=True):
        axes.set_ylabel(room.replace("_", " "), fontsize=SMALL, color=INK)
    figure.suptitle(
        "Betti numbers; loops (blue) above voids (violet), dashed what a bar must exceed to count",
        fontsize=SMALL + 1,
        color=INK,
    )
    return figure


def _limit(results: Sequence[Betti | None]) -> float:
    known = [result for result in results if result is not None]
    values = [np.append(result.ratios[d], result.thresholds[d]) for result in known for d in (1, 2)]
    together = np.concatenate([*values, [2.0]])
    return 1.15 * float(together[np.isfinite(together)].max())


def _draw(axes: Axes, result: Betti | None, expected: tuple[int, ...], limit: float) -> str:
    # A long axis has room for fewer.
    ticks = (1, 1.5, 2, 3, 5, 10, 30, 100) if limit < 15 else (1, 2, 5, 10, 30, 100)
    right = result is not None and result.numbers[: len(expected)] == expected
    tidy(axes, title=" ")
    axes.title.set_color(INK if right else BAD)
    axes.set_xscale("log")
    axes.set(yticks=[], xlim=(1, limit), ylim=(LOOPS + VOIDS - 0.2, -0.8))
    axes.xaxis.set_major_locator(FixedLocator(ticks))
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.xaxis.set_minor_locator(NullLocator())
    if result is None:
        return f"nothing, not {list(expected)}"
    for dimension, first, count, colour in ((1, 0, LOOPS, GOOD), (2, LOOPS, VOIDS, "#7b4fa3")):
        threshold, shown = result.thresholds[dimension], np.minimum(result.ratios[dimension][:count], limit)
        colours = [colour if rank < result.numbers[dimension] else SOFT for rank in range(len(shown))]
        axes.barh(first + np.arange(len(shown)), shown - 1, left=1, height=0.7, color=colours)
        rows = [first - 0.5, first + count - 0.5]
        axes.plot([threshold] * 2, rows, color=BAD, linewidth=1.2, linestyle="--")
    return f"{list(result.numbers)}" + ("" if right else f", not {list(expected)}")
