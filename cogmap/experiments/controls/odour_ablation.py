"""How many odours it takes, and how well they must be smelt."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from arena import Arena, Brownian, Camera, Nose, Recording
from cogmap.evaluation.populations import Ground, grow_map, perceive, trust
from cogmap.evaluation.scoring import score
from cogmap.experiments.conditions import FRESH_SEED, Setting, poses_of
from cogmap.experiments.result import Result
from cogmap.plots import plot_cases

PLACES = ((-1.5, -1.0), (1.6, 0.9), (1.2, -1.1), (-1.3, 1.0))
"""Of the sources in m, added one by one; the first three are those of every room."""
NOISE = (0.0, 0.1, 0.2, 0.3)
USUAL_SOURCES, USUAL_NOISE = 3, 0.1
LABELS = {"sources": "odour sources", "noise": "noise of the nose"}


def sources(setting: Setting) -> Result:
    """Learn the same views with one to four odour sources, and with a nose of no noise to one of 30 %.

    With few sources a smell can mean several places. `position_median_m` is read from the recalled odour,
    which stays ambiguous; `place_position_median_m` from the rates of the place cells by the same decoder:
    each of them keeps to one place (`neurons.atlas.disambiguation`). `single_field` is the share of place
    cells with exactly one field.
    """
    camera = Camera.panoramic()
    walk = setting.explore(Brownian(), camera)
    fresh = setting.explore(Brownian(), camera, fresh=True)
    ground = Ground.of(setting.room, poses_of(walk), poses_of(fresh))
    cases = [(count, USUAL_NOISE) for count in range(1, len(PLACES) + 1)]
    cases += [(USUAL_SOURCES, noise) for noise in NOISE if noise != USUAL_NOISE]
    metrics = {
        f"{count}_sources_{noise:g}_noise": _learn(setting, ground, walk, fresh, count=count, noise=noise)
        for count, noise in cases
    }
    table = pd.DataFrame(
        [
            {"sources": count, "noise": noise, **metrics[f"{count}_sources_{noise:g}_noise"]}
            for count, noise in cases
        ]
    )
    return Result(metrics=metrics, tables={"cases": table}, figures={"sources": plot_cases(table, LABELS)})


def smell(room: Arena, walk: Recording, *, count: int, noise: float, seed: int) -> np.ndarray:
    """Smell so many sources in a room on a walk that has been taken."""
    scented = room.model_copy(update={"sources": [{"position": place} for place in PLACES[:count]]})
    concentration = scented.odours.concentration(poses_of(walk)[:, :2])
    return Nose(noise=noise).smell(concentration, walk.times, np.random.default_rng(seed))


def _learn(
    setting: Setting, ground: Ground, walk: Recording, fresh: Recording, *, count: int, noise: float
) -> dict[str, Any]:
    smells = [
        smell(setting.room, one, count=count, noise=noise, seed=setting.seed + late)
        for one, late in ((walk, 0), (fresh, FRESH_SEED))
    ]
    cmap = grow_map(replace(walk, odours=smells[0]), setting.map, seed=setting.seed)
    known, asked = (perceive(cmap, one.views) for one in (walk, fresh))
    place = ground.measure(asked.place)
    return {
        **score(asked, ground.poses, train=(known, ground.known), reachable=ground.reachable),
        **{f"nose_{key}": value for key, value in ground.position(*map(np.log, smells)).items()},
        **{f"place_{key}": value for key, value in ground.position(known.place, asked.place).items()},
        "single_field": float((place.table["fields"] == 1).mean()),
        **trust(cmap),
    }
