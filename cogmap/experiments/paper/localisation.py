"""Localisation: where a view was taken, told by remembered views (Table 3)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from arena import Brownian, Camera
from arena.angles import wrap_angle
from cogmap.experiments import Conditions, Result, experiment, pose_columns, pose_errors
from cogmap.features import BagOfWords
from cogmap.navigation import Localiser, Location, image_codes
from cogmap.plots import plot_localisation, plot_neighbours


@experiment(room="furnished", views=17_000)
def localisation(conditions: Conditions, *, noise: float = 0.01) -> Result:
    """Table 3: place the views of a fresh walk, taken with a noisy camera, among remembered ones.

    Neighbours are found by bags of words, weights in blurred images; poses of the remembered views enter when
    all is done, as what the weights interpolate. `nearest_*` are the errors of the nearest view by words. A
    view that shows no known word has no place, and `placed` is the share of those that have. `noise` of the
    camera on the fresh walk is a share of the brightest grey level.
    """
    walk = conditions.explore(Brownian(), Camera.perspective())
    fresh = conditions.explore(Brownian(), Camera.perspective(noise=noise), fresh=True)
    words = BagOfWords(seed=conditions.seed, progress=conditions.progress)
    localiser = Localiser(words.fit_transform(walk.views), codes=image_codes(walk.views))
    found = localiser.locate(words.transform(fresh.views), codes=image_codes(fresh.views))
    train, truth = walk.require("poses"), fresh.require("poses")
    read = interpolated_poses(found, train)
    placed = found.indices[:, 0] >= 0
    nearest = np.where(placed[:, None], train[found.indices[:, 0]], np.nan)
    table = pd.DataFrame(
        {
            **pose_columns(truth),
            **pose_columns(read, "read_"),
            **pose_columns(nearest, "nearest_"),
            **pose_errors(read, truth),
            **pose_errors(nearest, truth, "nearest_"),
        }
    )
    # Table 3 has five queries with five neighbours each.
    shown = np.linspace(0, len(truth) - 1, min(5, len(truth))).astype(int)
    neighbours = np.maximum(found.indices[shown, :5], 0)
    return Result(
        metrics={"noise": noise, "placed": float(placed.mean()), **_summary(table)},
        tables={"views": table, "neighbours": _table_3(shown, neighbours, truth, train)},
        figures={
            "neighbours": plot_neighbours(
                np.asarray(fresh[shown].views),
                truth[shown],
                np.stack([[walk.views[view] for view in row] for row in neighbours]),
                train[neighbours],
            ),
            "errors": plot_localisation(table),
        },
        captions={
            "neighbours": "Fresh views beside the known views they are placed among",
            "errors": "How far from the true pose fresh views are placed",
        },
    )


def interpolated_poses(
    location: Location, poses: Float[np.ndarray, "views 3"]
) -> Float[np.ndarray, "queries 3"]:
    """Give Σ w · pose for each query; headings are counted from that of the nearest view, the short way."""
    near = poses[location.indices]
    ahead = near[:, :1, 2]
    turn = wrap_angle(near[:, :, 2] - ahead)
    heading = ahead[:, 0] + (location.weights * turn).sum(axis=1)
    places = (location.weights[:, :, None] * near[:, :, :2]).sum(axis=1)
    return np.column_stack([places, wrap_angle(heading)])


def _summary(table: pd.DataFrame) -> dict[str, Any]:
    return {
        f"{prefix}{what}_{name}_{unit}": float(np.nanpercentile(table[f"{prefix}{what}_error_{unit}"], share))
        for prefix in ("", "nearest_")
        for what, unit in (("position", "m"), ("heading", "deg"))
        for name, share in (("median", 50), ("p95", 95))
    }


def _table_3(
    queries: np.ndarray, neighbours: np.ndarray, truth: np.ndarray, train: np.ndarray
) -> pd.DataFrame:
    rank = np.tile(np.arange(1, neighbours.shape[1] + 1), len(queries))
    query, view = np.repeat(queries, neighbours.shape[1]), neighbours.ravel()
    return pd.DataFrame(
        {
            "query": query,
            "rank": rank,
            "view": view,
            **pose_columns(truth[query], "query_"),
            **pose_columns(train[view]),
            **pose_errors(train[view], truth[query]),
        }
    )
