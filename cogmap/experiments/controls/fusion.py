"""Sight alone, smell alone, and both: what cells come of each."""

from __future__ import annotations

import numpy as np

from arena import Brownian, Camera
from cogmap.evaluation.populations import Ground, as_one_table, competing_cells, grow_map, perceive, trust
from cogmap.evaluation.scoring import score
from cogmap.experiments.conditions import Setting, poses_of
from cogmap.experiments.result import Result
from cogmap.plots import plot_cell_types, plot_examples


def fusion(setting: Setting) -> Result:
    """Compare cells that see, cells that smell, and cells that see what smell has taught them.

    The same competitive layer learns from the Sanger codes of the views (`vision_only`) and from the log
    odour that the nose smells (`olfaction_only`); the two populations of the map (`fused`) fire from sight.
    All are measured on a fresh walk, each cell both as a place cell and as a head-direction cell.
    `place_cells_passing` and `heading_cells_passing` of `vision_only` and `olfaction_only` are of the same
    cells; `position_median_m` of `olfaction_only` is read from the raw nose. `in_field_direction_vector` is
    the median over the cells that have a field. `seconds` are those of learning, by stage; `reason` and
    `metric_reason` say why the map is not to be trusted, or lays out no places.
    """
    camera = Camera.panoramic()
    walk = setting.explore(Brownian(), camera)
    fresh = setting.explore(Brownian(), camera, fresh=True)
    cmap = grow_map(walk, setting.map, seed=setting.seed)
    ground = Ground.of(setting.room, poses_of(walk), poses_of(fresh))
    known, asked = (perceive(cmap, one.views) for one in (walk, fresh))
    codes = [cmap.encode(one.views) for one in (walk, fresh)]
    smells = [np.log(one.odours) for one in (walk, fresh)]
    rates = {
        "vision only": competing_cells(*codes, seed=setting.seed)[0],
        "olfaction only": competing_cells(*smells, seed=setting.seed)[0],
        "fused, place": asked.place,
        "fused, heading": asked.heading,
    }
    cells = {name: ground.measure(found) for name, found in rates.items()}
    alone = {
        name: {**cells[name].place_figures, **cells[name].heading_figures}
        for name in ("vision only", "olfaction only")
    }
    nose = ground.position(*smells)
    table = as_one_table(cells)
    return Result(
        metrics={
            "vision_only": alone["vision only"],
            "olfaction_only": {**alone["olfaction only"], **nose},
            "fused": {
                **cells["fused, place"].place_figures,
                **cells["fused, heading"].heading_figures,
                **score(asked, ground.poses, train=(known, ground.known), reachable=ground.reachable),
                **{f"nose_{key}": value for key, value in nose.items()},
                **trust(cmap),
                "metric_reason": cmap.metric_reason_,
                "seconds": {stage: round(spent, 3) for stage, spent in cmap.seconds_.items()},
            },
        },
        tables={"cells": table},
        figures={
            "cells": plot_cell_types(table),
            "examples": plot_examples({name: ground.tuning(found) for name, found in rates.items()}),
        },
    )
