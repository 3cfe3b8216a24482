"""Visual acuity: how sharp an eye must be, and how many charts a map must have."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from arena import Camera, Recording
from cogmap.evaluation.populations import trust_report, usual_charts
from cogmap.experiments import Conditions, Result, Trial, experiment
from cogmap.plots import plot_cases


@experiment(room="furnished", views=17_000, takes=("nose", "motion", "body", "map"))
def acuity(
    conditions: Conditions,
    *,
    eyes: tuple[int, ...] = (12, 24, 36, 60, 90, 360),
    shares: tuple[float, ...] = (0.125, 0.25, 0.5, 2.0),
) -> Result:
    """Learn the same walk through coarser and coarser eyes, and with fewer and more charts.

    `eyes` are numbers of columns around the body, the last the usual one, with a sixth as many rows; `shares`
    are parts of the usual number of charts.
    An eye of few columns has large pixels: 12 are 30° each. A view with fewer columns than the retina has
    receptors is enlarged, each pixel a block of its own, so that all else is the same for every eye. The
    usual number of charts is 3,000, or a third of the views when these are fewer than 9,000. Without a
    compass there is no error of heading.
    """
    usual = usual_charts(conditions.views)
    cases: dict[tuple[int, int], dict[str, Any]] = {}
    for columns in eyes:
        trial = explore_at_acuity(conditions, columns)
        fewer = [round(share * usual) for share in shares] if columns == eyes[-1] else []
        cases |= {(columns, charts): _learn(trial, charts) for charts in (usual, *fewer)}
    table = pd.DataFrame(
        [{"columns": eye, "charts": charts, **found} for (eye, charts), found in cases.items()]
    )
    return Result(
        metrics={f"{eye}_columns_{charts}_charts": found for (eye, charts), found in cases.items()},
        tables={"cases": table},
        figures={
            "acuity": plot_cases(table, {"columns": "columns of the eye", "charts": "charts"}, doubling=True)
        },
        captions={"acuity": "Errors and cells with ever more columns of the eye, and with ever more charts"},
    )


def explore_at_acuity(conditions: Conditions, columns: int) -> Trial:
    """Walk with an eye of so many columns, its pixels repeated until they are as many as receptors."""
    trial = Trial.of(conditions, camera=Camera.panoramic(columns, columns // 6))
    # The retina has 90 columns of receptors, and a coarser view is enlarged to no fewer.
    walk, fresh = (_enlarged(item, -(-90 // columns)) for item in (trial.walk, trial.fresh))
    return replace(trial, walk=walk, fresh=fresh)


def _enlarged(walk: Recording, times: int) -> Recording:
    if times == 1:
        return walk
    return replace(walk, views=np.asarray(walk.views).repeat(times, axis=1).repeat(times, axis=2))


def _learn(trial: Trial, charts: int) -> dict[str, Any]:
    conditions = trial.conditions
    trial = replace(trial, conditions=replace(conditions, map={**conditions.map, "charts": charts}))
    return {**trial.place.place_figures, **trial.score, **trust_report(trial.cmap)}
