"""Expectation: what will be seen one step ahead, before it is seen."""

from __future__ import annotations

import numpy as np
import pandas as pd
from jaxtyping import Int

from arena import Babble, Camera, Disc, explore
from arena.angles import wrap_angle
from cogmap.evaluation.image_quality import psnr
from cogmap.evaluation.populations import perceive
from cogmap.experiments import Conditions, Result, experiment, pose_columns
from cogmap.experiments.acting.dreamer import Dreamer
from cogmap.experiments.acting.travels import babble
from cogmap.experiments.conditions import FRESH_SEED
from cogmap.plots import plot_expectations

STEPS = 300
"""Of the fresh walk that are foretold."""
BABBLED = 3000
"""Steps that these are of."""
STRAIGHT, LONG = 0.1, 0.08
"""Turn (rad) up to which a step is straight, and how far (m) it must go."""


@experiment(room="furnished", views=17_000)
def expectation(conditions: Conditions) -> Result:
    """Expect the next view while babbling, from what is seen and what is commanded.

    The motor model is learnt from another spell of babbling. `ahead_psnr_db` is the median over straight steps
    of usual length, which truth picks and nothing else; `all_psnr_db` that over all steps, whatever the
    command and whatever was bumped into. Beside it persistence, which expects to see the same view again, and
    the same view turned to the direction that the body will face.
    """
    dreamer = Dreamer.of(conditions)
    cmap, dream, eye = dreamer.trial.cmap, dreamer.imagination, Camera.panoramic()
    motor = babble(conditions.room, eye, cmap, Disc(), conditions.seed)
    walk = explore(conditions.room, Babble(), eye, views=BABBLED, seed=conditions.seed + FRESH_SEED)
    poses, commands, views = walk.require("poses"), walk.require("commands"), np.asarray(walk.views)
    step = np.linalg.norm(np.diff(poses[:, :2], axis=0), axis=1)
    straight = (np.abs(wrap_angle(np.diff(poses[:, 2]))) < STRAIGHT) & (step > LONG)
    now = _spread(np.arange(1, len(step)), STEPS)
    now = np.union1d(now, _spread(np.flatnonzero(straight[1:]) + 1, STEPS))
    before, after = views[now], views[now + 1]
    expected = dream.ahead(before, motor, commands[now], previous=commands[now - 1]).views
    here, there = perceive(cmap, before), perceive(cmap, after)
    turned = dream.at(here.position, there.phase, method="turned").views
    table = pd.DataFrame(
        {
            **pose_columns(poses[now]),
            "step_m": step[now],
            "straight": straight[now],
            "ahead_psnr_db": psnr(expected, after),
            "persistence_psnr_db": psnr(before, after),
            "turned_psnr_db": psnr(turned, after),
        }
    )
    ahead = table[table["straight"]]
    shown = np.flatnonzero(straight[now])[:: max(1, len(ahead) // 4)][:4]
    names = ("ahead_psnr_db", "persistence_psnr_db", "turned_psnr_db")
    return Result(
        metrics={
            "steps": len(ahead),
            "step_median_m": float(ahead["step_m"].median()),
            **{key: float(ahead[key].median()) for key in names},
            "ahead_psnr_p05_db": float(ahead["ahead_psnr_db"].quantile(0.05)),
            "all_psnr_db": float(table["ahead_psnr_db"].median()),
        },
        tables={"steps": table},
        figures={"expected": plot_expectations(before[shown], expected[shown], after[shown], ahead)},
        captions={
            "expected": "What is seen, expected next and seen next, and how right it is on straight ways"
        },
    )


def _spread(rows: Int[np.ndarray, "rows"], count: int) -> Int[np.ndarray, "_"]:
    return rows[np.unique(np.linspace(0, len(rows) - 1, min(count, len(rows))).astype(int))]
