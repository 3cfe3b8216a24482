"""Expectation: what will be seen one step ahead, before it is seen."""

from __future__ import annotations

import numpy as np
import pandas as pd

from arena.angles import wrap_angle
from cogmap.evaluation.image_quality import psnr
from cogmap.evaluation.populations import perceive
from cogmap.experiments import Conditions, Result, experiment, pose_columns
from cogmap.experiments.acting.dreamer import Dreamer
from cogmap.plots import plot_expectations

STEPS = 300
"""Of the fresh walk that are foretold."""
STRAIGHT = 0.1
"""Turn (rad) up to which a step is straight, and share of the usual step that it must go."""


@experiment(room="furnished", views=17_000)
def expectation(conditions: Conditions) -> Result:
    """Expect the next view on straight ways of a fresh walk, as far ahead as the body usually got.

    `ahead_psnr_db` is the median over steps; beside it persistence, which expects to see the same view again,
    and the same view turned to the heading that it will have. Truth chooses the straight steps, nothing else.
    """
    dreamer = Dreamer.of(conditions)
    trial, dream = dreamer.trial, dreamer.imagination
    poses = trial.truth.poses
    step = np.linalg.norm(np.diff(poses[:, :2], axis=0), axis=1)
    straight = np.abs(wrap_angle(np.diff(poses[:, 2]))) < STRAIGHT
    straight &= step > 0.5 * np.median(step[straight])
    now = np.flatnonzero(straight)
    now = now[np.unique(np.linspace(0, len(now) - 1, STEPS).astype(int))]
    before, after = (
        np.stack([np.asarray(trial.fresh.views[view]) for view in rows]) for rows in (now, now + 1)
    )
    expected = dream.ahead(before).views
    # what persistence lacks is not the turn: the body goes straight on
    here, there = perceive(trial.cmap, before), perceive(trial.cmap, after)
    turned = dream.at(here.position, there.phase, method="turned").views
    table = pd.DataFrame(
        {
            **pose_columns(poses[now]),
            "step_m": step[now],
            "ahead_psnr_db": psnr(expected, after),
            "persistence_psnr_db": psnr(before, after),
            "turned_psnr_db": psnr(turned, after),
        }
    )
    shown = np.linspace(0, len(now) - 1, min(4, len(now))).astype(int)
    return Result(
        metrics={
            "steps": len(now),
            "step_median_m": float(np.median(step[now])),
            **{
                key: float(table[key].median())
                for key in ("ahead_psnr_db", "persistence_psnr_db", "turned_psnr_db")
            },
            "ahead_psnr_p05_db": float(table["ahead_psnr_db"].quantile(0.05)),
        },
        tables={"steps": table},
        figures={"expected": plot_expectations(before[shown], expected[shown], after[shown], table)},
        captions={
            "expected": "What is seen, what is expected next and what is seen next; errors of all steps"
        },
    )
