"""Populations of cells: a map grown from a walk, and cells that compete for anything."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
import torch
from jaxtyping import Float
from numpy.typing import ArrayLike

from arena import Arena, Body, Recording
from cogmap.errors import UntrustedMapWarning
from cogmap.map.activity import Activity
from cogmap.map.cognitive_map import BATCH, CognitiveMap
from cogmap.threads import one_thread
from neurons.layers.place_cells import PlaceCells
from neurons.stages import CellStage


def usual_charts(views: int) -> int:
    """Count the charts that a map of so many views should have, at least three views each."""
    return min(3000, views // 3)


def grow_map(
    walk: Recording, parameters: Mapping[str, Any], *, seed: int, progress: bool = False
) -> CognitiveMap:
    """Learn a map with 3,000 charts, or a third as many as views when these are fewer than 9,000.

    Parameters of `CognitiveMap` that are given go before these.
    """
    usual = {"charts": usual_charts(len(walk)), "seed": seed}
    return CognitiveMap(**{**usual, **parameters}).fit(walk.views, walk.odours, progress=progress)


def perceive(cmap: CognitiveMap, views: Any, odours: ArrayLike | None = None) -> Activity:
    """Let a map look, and smell; one that is not to be trusted says so in the metrics, not in a warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UntrustedMapWarning)
        return cmap.perceive(views, odours=odours)


def trust_report(cmap: CognitiveMap) -> dict[str, Any]:
    """Whether a map is to be trusted, and why not."""
    return {"trusted": cmap.trusted_, "reason": cmap.reason_}


def competing_cells(
    train: Float[np.ndarray, "train inputs"],
    *test: Float[np.ndarray, "_ inputs"],
    seed: int,
    cells: int = 150,
) -> list[Float[np.ndarray, "_ cells"]]:
    """Let the place cells' layer compete for any inputs, as long as in a map, and give its rates in Hz.

    There are as many cells as a map has place cells, unless told.
    """
    inputs = torch.from_numpy(np.asarray(train, np.float32))
    order = np.random.default_rng(seed)
    layer = PlaceCells(cells, 1, inputs.shape[1])
    with one_thread():
        for _ in range(CellStage.epochs):
            for rows in torch.from_numpy(order.permutation(len(inputs))).split(BATCH):
                layer.compete(inputs[rows], window=float(len(inputs)))
        return [layer.tuning(torch.from_numpy(np.asarray(batch, np.float32))).numpy() for batch in test]


def reachable_places(room: Arena, body: Body) -> Float[np.ndarray, "points 2"]:
    """Draw places (m) that a body can reach, dense enough for every bin of a rate map to hold some."""
    return room.sample_free(20_000, body.radius, np.random.default_rng(0))
