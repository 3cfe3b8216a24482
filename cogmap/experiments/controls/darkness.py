"""Darkness: the same cells in the light without smell, and in the dark by smell alone."""

from __future__ import annotations

import numpy as np

from cogmap.evaluation.ground_truth import as_one_table, map_correlations
from cogmap.evaluation.scoring import score
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.registry import experiment
from cogmap.experiments.result import Result
from cogmap.experiments.trial import Trial
from cogmap.plots import plot_cell_types, plot_examples


@experiment(room="furnished", views=17_000, takes=("nose", "motion", "camera", "body", "map"))
def darkness(conditions: Conditions) -> Result:
    """Take one sense away from a map that has learnt with both.

    `sight` is the map looking with its nose blocked, `smell` the map in the dark, on the same fresh walk. In
    the dark its heading cells are silent. `map_correlation` is the median over place cells of the correlation
    of the rate map in the dark with that in the light: whether the same cell means the same place.
    """
    trial = Trial.of(conditions)
    truth, cmap = trial.truth, trial.cmap
    dark, smelt = (cmap.perceive(odours=item.odours) for item in (trial.fresh, trial.walk))
    cells = {
        "sight, place": trial.place,
        "sight, heading": trial.heading,
        "smell, place": truth.measure(dark.place),
        "smell, heading": truth.measure(dark.heading),
    }
    scores = {
        "sight": trial.score,
        "smell": score(
            dark,
            truth.poses,
            train=(smelt, truth.train),
            reachable=truth.reachable,
            cells=(cells["smell, place"], cells["smell, heading"]),
        ),
    }
    same = map_correlations(cells["sight, place"].maps, cells["smell, place"].maps)
    table = as_one_table(cells)
    metrics = {
        name: {
            **cells[f"{name}, place"].place_figures,
            **cells[f"{name}, heading"].heading_figures,
            **figures,
        }
        for name, figures in scores.items()
    }
    return Result(
        metrics={**metrics, "map_correlation": float(np.nanmedian(same))},
        tables={"cells": table},
        figures={
            "cells": plot_cell_types(table),
            "examples": plot_examples(
                {name: found.tuning for name, found in cells.items() if found.rates.any()}
            ),
        },
        captions={
            "cells": "What each cell tells of position and of heading, by population",
            "examples": "Six cells of each population: rate maps, and rate by heading",
        },
    )
