"""How cost grows, drawn: a log–log panel for each thing that is counted."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from cogmap.plots.style import GOOD, SOFT, TINY, new_panels, plain_ticks, tidy

COLUMNS = 4


def plot_growth(scaling: Mapping[str, Any]) -> Figure:
    """Draw seconds against sizes as dots, with the power law that fits them.

    Parameters
    ----------
    scaling
        What `benchmarks.scaling.scaling` gives: `growth` by names such as `learning_by_views`; what else is
        in it is not drawn.
    """
    grown = {name: found for name, found in scaling.items() if isinstance(found, Mapping)}
    rows = -(-len(grown) // COLUMNS)
    figure, panels = new_panels(11.0, 2.8 * rows, rows, COLUMNS, squeeze=False)
    for axes, (name, found) in zip(panels.flat, grown.items(), strict=False):
        _draw(axes, name.replace("_", " "), found)
    for axes in panels.flat[len(grown) :]:
        axes.set_axis_off()
    return figure


def _draw(axes: Axes, name: str, found: Mapping[str, Any]) -> None:
    what, by = name.split(" by ")
    sizes, spent = np.array(found["sizes"], float), 1e3 * np.array(found["seconds"])
    law = sizes ** found["exponent"]
    # least squares in logarithms: the line goes through the geometric means
    law *= np.exp(np.mean(np.log(spent / law)))
    axes.loglog(sizes, law, color=SOFT, linewidth=1)
    axes.loglog(sizes, spent, "o", color=GOOD, markersize=4)
    tidy(
        axes,
        x=by,
        y="time (ms)",
        title=f"{what}, exponent {found['exponent']:.2f} ± {found['exponent_error']:.2f}",
    )
    plain_ticks(axes.xaxis, sizes.tolist())
    axes.tick_params(axis="x", rotation=45, labelsize=TINY)
    # at least a factor of ten, or what hardly grows looks steep
    least, most = min(law.min(), spent.min()), max(law.max(), spent.max())
    middle, half = np.sqrt(least * most), max(np.sqrt(10), 1.2 * np.sqrt(most / least))
    axes.set_ylim(middle / half, middle * half)
    plain_ticks(axes.yaxis, LogLocator(subs=(1, 2, 5) if half < 10 else (1,)))
