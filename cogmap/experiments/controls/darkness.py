"""Darkness: the same cells in the light without smell, and in the dark by smell alone."""

from __future__ import annotations

import numpy as np

from cogmap.evaluation.ground_truth import map_correlations
from cogmap.evaluation.scoring import score
from cogmap.experiments import Conditions, Result, Trial, experiment, show_cells


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
    by_smell = score(
        dark,
        truth.poses,
        train=(smelt, truth.train),
        reachable=truth.reachable,
        cells=(cells["smell, place"], cells["smell, heading"]),
    )
    same = map_correlations(cells["sight, place"].maps, cells["smell, place"].maps)
    return Result(
        {
            "sight": trial.figures,
            "smell": {
                **cells["smell, place"].place_figures,
                **cells["smell, heading"].heading_figures,
                **by_smell,
            },
            "map_correlation": float(np.nanmedian(same)),
        },
        *show_cells(cells, silent=False),
    )
