"""Barcodes of many clouds at a glance: loops and voids, a line per room, a column per cloud."""

from __future__ import annotations

from collections.abc import Mapping

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cogmap.errors import CogmapError
from cogmap.plots.shape.barcodes import draw_bars, limit_of
from cogmap.plots.style import BAD, GOOD, INK, SMALL, new_panels, plain_ticks, tidy
from cogmap.shape.homology import Betti

LOOPS, VOIDS = 6, 4
"""The largest that are drawn."""


def plot_barcode_grid(
    results: Mapping[str, Mapping[str, Betti | None]], expected: Mapping[str, Mapping[str, tuple[int, ...]]]
) -> Figure:
    """Draw the largest loops and voids of every cloud as π = death / birth, a line of panels per room.

    Loops stand above voids. Bars that count are coloured, and the dashed line across them is what they must
    exceed. The title of a panel tells the numbers found, those that are not resolved with a question mark;
    where they are not as expected it is red and tells those too. The panels of a column share their
    logarithmic axis.

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
    rows, columns = len(results), len(clouds)
    figure, panels = new_panels(width * columns + 0.5, height * rows + 0.9, rows, columns, squeeze=False)
    for column, name in zip(panels.T, clouds, strict=True):
        found = [result[name] for result in results.values()]
        # A column without any cloud has an axis too.
        limit = limit_of([result for result in found if result is not None], (1, 2), 2.0)
        for axes, room in zip(column, results, strict=True):
            title = _draw(axes, results[room][name], expected[room][name], limit)
            title = f"{name.replace('_', ' ')}\n{title}" if axes is column[0] else title
            axes.set_title(title, fontsize=SMALL)
        column[-1].set_xlabel("π = death / birth, no unit", fontsize=SMALL, color=INK)
    for axes, room in zip(panels[:, 0], results, strict=True):
        axes.set_ylabel(room.replace("_", " "), fontsize=SMALL, color=INK)
    title = "Betti numbers (? unresolved); loops (blue) above voids (violet), dashed what a bar must exceed"
    figure.suptitle(title, fontsize=SMALL + 1, color=INK)
    return figure


def _draw(axes: Axes, result: Betti | None, expected: tuple[int, ...], limit: float) -> str:
    # A long axis has room for fewer.
    ticks = (1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 30.0, 100.0) if limit < 15 else (1.0, 2.0, 5.0, 10.0, 30.0, 100.0)
    right = result is not None and result.numbers[: len(expected)] == expected
    tidy(axes, title=" ")
    axes.title.set_color(INK if right else BAD)
    axes.set(xscale="log", yticks=[], xlim=(1, limit), ylim=(LOOPS + VOIDS - 0.2, -0.8))
    plain_ticks(axes.xaxis, ticks)
    if result is None:
        return f"nothing, not {list(expected)}"
    for dimension, first, count, colour in ((1, 0, LOOPS, GOOD), (2, LOOPS, VOIDS, "#7b4fa3")):
        draw_bars(axes, result, dimension, count, colour, first=first)
        rows = [first - 0.5, first + count - 0.5]
        axes.plot([result.thresholds[dimension]] * 2, rows, color=BAD, linewidth=1.2, linestyle="--")
    told = (f"{b}" if sure else f"{b}?" for b, sure in zip(result.numbers, result.resolved, strict=True))
    return f"[{', '.join(told)}]" + ("" if right else f", not {list(expected)}")
