"""Remapping: fields of the same cells in several rooms, and how alike rooms are to the population."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from cogmap.cells import RateMaps
from cogmap.plots.many_rooms.fields import chosen, draw_cell
from cogmap.plots.style import BAD, GOOD, INK, SMALL, SOFT, TINY, colour_bar, new_figure, tidy

CELLS = 6
KINDS = {"global": BAD, "rate": GOOD, "none": SOFT}


def plot_remapping(rooms: Mapping[str, RateMaps], pairs: pd.DataFrame, changes: pd.DataFrame) -> Figure:
    """Draw rate maps of six cells in every room, and below them correlations between rooms and changes.

    Parameters
    ----------
    rooms
        Maps of the same place cells by the name of the room; the six fire most in the first.
    pairs
        `room`, `other_room` and `correlation` of population vectors, a row a pair.
    changes
        `change`, `remapping_index` and `remapping` (global, rate or none), a row a change.

    Raises
    ------
    CogmapError
        Without a room.
    """
    shown = chosen(rooms, CELLS)
    figure = new_figure(1.15 * len(rooms) + 0.6, 0.95 * CELLS + 4.2)
    above, below = figure.subfigures(2, 1, squeeze=False, height_ratios=[0.95 * CELLS + 0.3, 3.9])[:, 0]
    panels = above.subplots(CELLS, len(rooms), squeeze=False)
    for line, cell in zip(panels, shown, strict=False):
        scale = draw_cell(line, rooms, cell)
        line[0].set_ylabel(f"cell {cell}", fontsize=TINY, color=INK)
        colour_bar(line[-1], scale, "Hz")
    for axes, name in zip(panels[0], rooms, strict=True):
        axes.set_title(name.replace("_", "\n"), fontsize=TINY, color=INK)
    left, right = below.subplots(1, 2, width_ratios=[1, 1.1])
    names = list(rooms)
    matrix = np.eye(len(names))
    for one, other, r in zip(pairs["room"], pairs["other_room"], pairs["correlation"], strict=True):
        i, j = names.index(one), names.index(other)
        matrix[i, j] = matrix[j, i] = r
    tidy(left, title="population vectors, place by place", size=SMALL)
    image = left.imshow(matrix, cmap="RdBu_r", vmin=-1, vmax=1)
    plain = [name.replace("_", " ") for name in names]
    left.set_xticks(range(len(names)), plain, rotation=60, ha="right", fontsize=TINY)
    left.set_yticks(range(len(names)), plain, fontsize=TINY)
    colour_bar(left, image, "correlation")
    tidy(right, x="remapping index", title="what changes in the first room", size=SMALL)
    places = np.arange(len(changes))[::-1]
    colours = changes["remapping"].map(KINDS)
    right.barh(places, changes["remapping_index"].clip(lower=0), color=colours, height=0.6)
    right.set_yticks(places, changes["change"], fontsize=TINY)
    right.set_xlim(0, 1.25)
    for place, index, kind in zip(places, changes["remapping_index"], changes["remapping"], strict=True):
        right.text(max(index, 0) + 0.03, place, kind, va="center", fontsize=TINY, color=INK)
    return figure
