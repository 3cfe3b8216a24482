"""Image similarity: which measure of it knows views from nearby poses."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from arena import Brownian, Camera
from cogmap.evaluation.pose_agreement import motion_distances, pose_agreement
from cogmap.experiments import Conditions, Result, experiment, pose_errors
from cogmap.features import BagOfWords, cosine_distances, earth_mover_distances, pixel_distances
from cogmap.plots import plot_likeness


@experiment(room="furnished", views=5_000)
def similarity(conditions: Conditions, *, queries: int = 500, neighbours: int = 10) -> Result:
    """Compare pixels, bags of words and moved light by the poses of the views that they call alike.

    Pixels and words are those of the perspective camera; light is moved around panoramic strips taken from
    the same poses. Each measure looks for the `neighbours` most like each of the `queries`,
    views of a fresh walk.
    """
    ahead, around = Camera.perspective(), Camera.panoramic()
    count = min(queries, conditions.views)
    walk = conditions.explore(Brownian(), ahead)
    fresh = conditions.explore(Brownian(), ahead, views=count, fresh=True)
    poses, test = walk.require("poses"), fresh.require("poses")
    words = BagOfWords(seed=conditions.seed, progress=conditions.progress)
    train = words.fit_transform(walk.views)
    distances = {
        "euclidean": pixel_distances(fresh.views, walk.views),
        "bag_of_words": cosine_distances(words.transform(fresh.views), train),
        "earth_mover": earth_mover_distances(
            conditions.explore(Brownian(), around, views=count, fresh=True).views,
            conditions.explore(Brownian(), around).views,
        ),
    }
    metrics: dict[str, Any] = {
        name: pose_agreement(found, test, poses, neighbours=neighbours)._asdict()
        for name, found in distances.items()
    }
    best = {name: found.argmin(axis=1) for name, found in distances.items()}
    best["pose"] = motion_distances(test, poses).argmin(axis=1)
    table = _nearest_table(best, test, poses)
    shown = np.linspace(0, count - 1, min(4, count)).astype(int)
    pictures = {"query": np.asarray(fresh[shown].views)} | {
        name: np.asarray(walk[found[shown]].views) for name, found in best.items()
    }
    return Result(
        metrics=metrics,
        tables={"nearest": table},
        figures={"likeness": plot_likeness(table, pictures)},
        captions={"likeness": "Which views each measure of likeness takes for the same"},
    )


def _nearest_table(
    best: dict[str, Int[np.ndarray, "queries"]],
    test: Float[np.ndarray, "queries 3"],
    poses: Float[np.ndarray, "views 3"],
) -> pd.DataFrame:
    """Tell how far in pose the view is that each measure finds most like each query."""
    return pd.concat(
        [
            pd.DataFrame(
                {
                    "measure": name,
                    "query": np.arange(len(test)),
                    "view": found,
                    **pose_errors(poses[found], test),
                }
            )
            for name, found in best.items()
        ],
        ignore_index=True,
    )
