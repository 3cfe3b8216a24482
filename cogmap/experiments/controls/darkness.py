"""The same cells in the light without smell, and in the dark by smell alone."""

from __future__ import annotations

import numpy as np

from arena import Brownian, Camera
from cogmap.evaluation.populations import Ground, as_one_table, grow_map, map_correlations, perceive
from cogmap.evaluation.scoring import score
from cogmap.experiments.conditions import Setting, poses_of
from cogmap.experiments.result import Result
from cogmap.plots import plot_cell_types, plot_examples


def darkness(setting: Setting) -> Result:
    """Take one sense away from a map that has learnt with both.

    `sight` is the map looking with its nose blocked, `smell` the map in the dark, on the same fresh walk. In
    the dark its heading cells are silent. `map_correlation` is the median over place cells of the correlation
    of the rate map in the dark with that in the light: whether the same cell means the same place.
    """
    camera = Camera.panoramic()
    walk = setting.explore(Brownian(), camera)
    fresh = setting.explore(Brownian(), camera, fresh=True)
    cmap = grow_map(walk, setting.map, seed=setting.seed)
    ground = Ground.of(setting.room, poses_of(walk), poses_of(fresh))
    train = perceive(cmap, walk.views), ground.known
    light, dark = perceive(cmap, fresh.views), cmap.perceive(odours=fresh.odours)
    smelt = cmap.perceive(odours=walk.odours), ground.known
    rates = {
        "sight, place": light.place,
        "sight, heading": light.heading,
        "smell, place": dark.place,
        "smell, heading": dark.heading,
    }
    cells = {name: ground.measure(found) for name, found in rates.items()}
    same = map_correlations(ground.maps(light.place), ground.maps(dark.place))
    table = as_one_table(cells)
    metrics = {
        name: {
            **cells[f"{name}, place"].place_figures,
            **cells[f"{name}, heading"].heading_figures,
            **score(seen, ground.poses, train=learnt, reachable=ground.reachable),
        }
        for name, seen, learnt in (("sight", light, train), ("smell", dark, smelt))
    }
    return Result(
        metrics={**metrics, "map_correlation": float(np.nanmedian(same))},
        tables={"cells": table},
        figures={
            "cells": plot_cell_types(table),
            "examples": plot_examples(
                {name: ground.tuning(found) for name, found in rates.items() if np.nan_to_num(found).any()}
            ),
        },
    )
