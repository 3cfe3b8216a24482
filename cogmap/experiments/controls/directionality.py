"""Directionality of place cells: in the open field, and on a path where nobody turns."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from matplotlib.figure import Figure

from arena import Brownian, Motion, Track
from cogmap.cells.measures.place import MOST_DIRECTION
from cogmap.evaluation.ground_truth import CellMetrics, as_one_table
from cogmap.evaluation.populations import competing_cells, trust_report
from cogmap.experiments import Conditions, Result, Trial, experiment
from cogmap.plots import plot_cell_types, plot_examples


@experiment(room="furnished", views=17_000, takes=("nose", "camera", "body", "map"))
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
    examples: dict[str, Figure] = {}
    walks: dict[str, Motion] = {"open_field": Brownian(), "corridor": Track()}
    for name, motion in walks.items():
        trial = replace(Trial.of(conditions, motion), reachable=None)
        found = {
            "vision_only": trial.truth.measure(competing_cells(*trial.codes, seed=conditions.seed)[0]),
            "fused": trial.place,
        }
        told = {kind: {**item.place_figures, "directional": _share(item)} for kind, item in found.items()}
        metrics[name] = {**told, **trust_report(trial.cmap)}
        here = {f"{name}, {kind}".replace("_", " "): item for kind, item in found.items()}
        examples[f"examples_{name}"] = plot_examples({kind: item.tuning for kind, item in here.items()})
        cells |= here
    table = as_one_table(cells)
    return Result(
        metrics=metrics,
        tables={"cells": table},
        figures={"cells": plot_cell_types(table), **examples},
        captions={
            "cells": "What each cell tells of position and of heading, by walk and population",
            "examples_open_field": "Six cells of each population in the open field",
            "examples_corridor": "Six cells of each population in the corridor",
        },
    )


def _share(found: CellMetrics) -> float:
    """Share of directional cells among those with a field; 0 without any."""
    vectors = found.place["in_field_direction_vector"].dropna()
    # So long a vector is that of a cell that fires three times as much one way as the other, 2 + cos θ.
    return float((vectors > MOST_DIRECTION).mean()) if len(vectors) else 0.0
