"""Odour ablation: how many odours it takes, and how well they must be smelt."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from arena import Arena, Nose, Recording
from cogmap.evaluation.populations import trust_report
from cogmap.experiments import Conditions, Result, Trial, experiment
from cogmap.experiments.conditions import FRESH_SEED
from cogmap.plots import plot_cases

PLACES = ((-1.5, -1.0), (1.6, 0.9), (1.2, -1.1), (-1.3, 1.0))
"""Of the sources in m, added one by one; the first three are those of every room."""


@experiment(room="furnished", views=17_000, takes=("motion", "camera", "body", "map"))
def odour_ablation(conditions: Conditions, *, noises: tuple[float, ...] = (0.0, 0.1, 0.2, 0.3)) -> Result:
    """Learn the same views with one to four odour sources, and with a nose of no noise to one of 30 %.

    With few sources a smell can mean several places. `position_median_m` is read from the recalled odour,
    which stays ambiguous; `place_position_median_m` from the rates of the place cells by the same decoder:
    each of them keeps to one place (`neurons.atlas.disambiguation`). `single_field` is the share of place
    cells with exactly one field.
    """
    trial = Trial.of(conditions)
    # The usual nose has a noise of 10 %, the usual room three sources.
    given = [(count, 0.1) for count in range(1, len(PLACES) + 1)]
    given += [(3, noise) for noise in noises if noise != 0.1]
    cases = {(count, noise): _learn(trial, count, noise) for count, noise in given}
    table = pd.DataFrame(
        [{"sources": count, "noise": noise, **found} for (count, noise), found in cases.items()]
    )
    return Result(
        metrics={f"{count}_sources_{noise:g}_noise": found for (count, noise), found in cases.items()},
        tables={"cases": table},
        figures={"sources": plot_cases(table, {"sources": "odour sources", "noise": "noise of the nose"})},
        captions={
            "sources": "What the cells tell of place with more sources of smell, and with a noisier nose"
        },
    )


def smell(room: Arena, walk: Recording, *, count: int, noise: float, seed: int) -> np.ndarray:
    """Smell so many sources in a room on a walk that has been taken."""
    scented = room.model_copy(update={"sources": [{"position": place} for place in PLACES[:count]]})
    concentration = scented.odours.concentration(walk.require("poses")[:, :2])
    return Nose(noise=noise).smell(concentration, walk.times, np.random.default_rng(seed))


def _learn(trial: Trial, count: int, noise: float) -> dict[str, Any]:
    conditions = trial.conditions
    walk, fresh = (
        replace(item, odours=smell(conditions.room, item, count=count, noise=noise, seed=seed))
        for item, seed in ((trial.walk, conditions.seed), (trial.fresh, conditions.seed + FRESH_SEED))
    )
    trial = replace(trial, walk=walk, fresh=fresh)
    place = trial.truth.position(trial.train.place, trial.test.place)
    return {
        **trial.score,
        **trial.nose_figures,
        **{f"place_{key}": value for key, value in place.items()},
        "single_field": float((trial.place.place["fields"] == 1).mean()),
        **trust_report(trial.cmap),
    }
