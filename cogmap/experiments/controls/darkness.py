"""Darkness: the same cells in the light without smell, and in the dark by smell alone."""

from __future__ import annotations

import numpy as np

from arena import Brownian, Camera
from cogmap.evaluation.populations import GroundTruth, as_one_table, grow_map, map_correlations, perceive
from cogmap.evaluation.scoring import score
from cogmap.experiments.conditions import Conditions, poses_of
from cogmap.experiments.registry import experiment
from cogmap.experiments.result import Result
from cogmap.plots import plot_cell_types, plot_examples


@experiment(room="furnished", views=17_000, takes=("nose", "motion", "camera", "map"))
def darkness(conditions: Conditions) -> Result:
    """Take one sense away from a map that has learnt with both.

    `sight` is the map looking with its nose blocked, `smell` the map in the dark, on the same fresh walk. In
    the dark its heading cells are silent. `map_correlation` is the median over place cells of the correlation
    of the rate map in the dark with that in the light: whether the same cell means the same place.
    """
    camera = Camera.panoramic()
    walk = conditions.explore(Brownian(), camera)
    fresh = conditions.explore(Brownian(), camera, fresh=True)
    cmap = grow_map(walk, conditions.map, seed=conditions.seed)
    truth = GroundTruth.of(conditions.room, poses_of(walk), poses_of(fresh))
    train = perceive(cmap, walk.views), truth.train
    light, dark = perceive(cmap, fresh.views), cmap.perceive(odours=fresh.odours)
    smelt = cmap.perceive(odours=walk.odours), truth.train
    rates = {
        "sight, place": light.place,
        "sight, heading": light.heading,
        "smell, place": dark.place,
        "smell, heading": dark.heading,
    }
    cells = {name: truth.measure(found) for name, found in rates.items()}
    same = map_correlations(truth.maps(light.place), truth.maps(dark.place))
    table = as_one_table(cells)
    metrics = {
        name: {
            **cells[f"{name}, place"].place_figures,
            **cells[f"{name}, heading"].heading_figures,
            **score(seen, truth.poses, train=learnt, reachable=truth.reachable),
        }
        for name, seen, learnt in (("sight", light, train), ("smell", dark, smelt))
    }
    return Result(
        metrics={**metrics, "map_correlation": float(np.nanmedian(same))},
        tables={"cells": table},
        figures={
            "cells": plot_cell_types(table),
            "examples": plot_examples(
                {name: truth.tuning(found) for name, found in rates.items() if np.nan_to_num(found).any()}
            ),
        },
        captions={
            "cells": "What each cell tells of position and of heading, by population",
            "examples": "Six cells of each population: rate maps, and rate by heading",
        },
    )
