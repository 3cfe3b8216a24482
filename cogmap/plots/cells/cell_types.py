"""Cell types: which cells are place cells, which head-direction cells, and which neither."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from cogmap.cells.measures.heading import LEAST_VECTOR, MOST_INFORMATION
from cogmap.cells.measures.place import LEAST_INFORMATION, MOST_DIRECTION
from cogmap.errors import CogmapError
from cogmap.plots.style import ABSENT, BAD, GOOD, SMALL, SOFT, new_panels, tidy


def plot_cell_types(cells: pd.DataFrame) -> Figure:
    """Draw every cell by how much it tells of place and of direction, one column of panels a population.

    Above each is judged as a place cell, below as a head-direction cell: blue passes, red does not. The grey
    area is where it must lie to pass; to be one it needs a single field, or little drift, besides.

    Parameters
    ----------
    cells
        `population`, `spatial_information` and `spatial_information_beyond_heading` (bit/spike),
        `in_field_direction_vector`, `mean_vector_length`, `place_passing` and `heading_passing`, a row a
        cell. A cell without a field has no in-field vector and is missing above.

    Raises
    ------
    CogmapError
        Without a cell.
    """
    panel = 2.4  # inches
    names = list(dict.fromkeys(cells["population"]))
    if not names:
        raise CogmapError("no cells to draw; give a table with at least one")
    most = max(1.08 * float(cells["spatial_information"].fillna(0.0).max()), 1.0)
    kinds = {
        "place": ("in_field_direction_vector", "in-field direction vector", "spatial_information"),
        "heading": ("mean_vector_length", "mean vector length", "spatial_information_beyond_heading"),
    }
    # Where a cell of each kind must lie to pass: from left to right, from low to high.
    criteria = (-0.02, MOST_DIRECTION, LEAST_INFORMATION, most), (LEAST_VECTOR, 1.02, 0.0, MOST_INFORMATION)
    width = panel * max(len(names), 2) + 0.6
    figure, panels = new_panels(width, 2 * panel + 0.4, 2, len(names), squeeze=False, sharey=True)
    for column, name in zip(panels.T, names, strict=True):
        told = "spatial information (bit/spike)" if name == names[0] else ""
        rows = zip(column, kinds.items(), criteria, strict=True)
        for axes, (kind, (key, label, information)), criterion in rows:
            left, right, low, high = criterion
            mine = cells[cells["population"] == name]
            passing = mine[f"{kind}_passing"]
            title = f"{name}\n{passing.mean():.0%} {kind} cells"
            tidy(axes, x=label, y=told, title=title, size=SMALL - 1)
            axes.fill_between([left, right], low, high, color=ABSENT, alpha=0.5, linewidth=0, zorder=0)
            outline = [left, right, right, left, left], [low, low, high, high, low]
            axes.plot(*outline, color=SOFT, linewidth=0.6)
            colours = passing.map({True: GOOD, False: BAD})
            axes.scatter(mine[key], mine[information], s=7, c=colours, alpha=0.7, linewidths=0)
            axes.set(xlim=(-0.02, 1.02), ylim=(0, most))
    return figure
