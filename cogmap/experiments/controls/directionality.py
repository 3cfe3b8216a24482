"""Directionality of place cells: in the open field, and on a path where nobody turns."""

from __future__ import annotations

from typing import Any

from arena import Brownian, Camera, Motion, Track
from cogmap.cells import Tuning
from cogmap.evaluation.populations import (
    CellMetrics,
    GroundTruth,
    as_one_table,
    competing_cells,
    grow_map,
    perceive,
    trust_report,
)
from cogmap.experiments.conditions import Conditions, poses_of
from cogmap.experiments.registry import experiment
from cogmap.experiments.result import Result
from cogmap.plots import plot_cell_types, plot_examples

DIRECTIONAL = 0.5
"""A longer in-field vector is that of a cell that fires three times as much one way as the other."""
WALKS: dict[str, Motion] = {"open_field": Brownian(), "corridor": Track()}


@experiment(room="furnished", views=17_000, takes=("nose", "camera", "map"))
def directionality(conditions: Conditions) -> Result:
    """Learn the same room all over and on a straight path, and ask in which direction its place cells fire.

    `directional` is the share of cells with a field whose in-field direction vector is longer than .5. On the
    path only two headings are met between the ends, and no turn joins them: the active charts of a unit fall
    into two groups, one a direction, and the unit keeps to one of them. `vision_only` are cells that compete
    for the Sanger codes.

    References
    ----------
    McNaughton, Barnes & O'Keefe (1983), Experimental Brain Research 52; Muller, Bostock, Taube & Kubie
    (1994), Journal of Neuroscience 14: place cells are directional on paths and not in the open.
    """
    metrics: dict[str, Any] = {}
    cells: dict[str, CellMetrics] = {}
    drawn: dict[str, dict[str, Tuning]] = {}
    for name, motion in WALKS.items():
        walk = conditions.explore(motion, Camera.panoramic())
        fresh = conditions.explore(motion, Camera.panoramic(), fresh=True)
        train = poses_of(walk)
        truth = GroundTruth(train, poses_of(fresh), train[:, :2])
        cmap = grow_map(walk, conditions.map, seed=conditions.seed)
        codes = cmap.encode(walk.views), cmap.encode(fresh.views)
        rates = {
            "vision_only": competing_cells(*codes, seed=conditions.seed)[0],
            "fused": perceive(cmap, fresh.views).place,
        }
        found = {kind: truth.measure(batch) for kind, batch in rates.items()}
        metrics[name] = {
            kind: {**item.place_figures, "directional": _share(item)} for kind, item in found.items()
        }
        metrics[name] |= trust_report(cmap)
        label = name.replace("_", " ")
        cells |= {f"{label}, {kind.replace('_', ' ')}": item for kind, item in found.items()}
        drawn[name] = {
            f"{label}, {kind.replace('_', ' ')}": truth.tuning(batch) for kind, batch in rates.items()
        }
    table = as_one_table(cells)
    return Result(
        metrics=metrics,
        tables={"cells": table},
        figures={
            "cells": plot_cell_types(table),
            **{f"examples_{name}": plot_examples(batch) for name, batch in drawn.items()},
        },
        captions={
            "cells": "What each cell tells of position and of heading, by walk and population",
            **{
                f"examples_{name}": f"Six cells of each population in the {name.replace('_', ' ')}"
                for name in drawn
            },
        },
    )


def _share(found: CellMetrics) -> float:
    """Share of directional cells among those with a field; 0 without any."""
    vectors = found.table["in_field_direction_vector"].dropna()
    return float((vectors > DIRECTIONAL).mean()) if len(vectors) else 0.0
