"""Slow features beside the fusion, on the same views, learnt on four walks."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from arena import Brownian, Camera, Motion, Track
from arena.motions.slow_turning import SlowTurning
from cogmap.evaluation.ground_truth import CellMetrics, as_one_table
from cogmap.evaluation.peers.slow_features import slow_cells
from cogmap.evaluation.populations import trust_report
from cogmap.experiments import Conditions, Result, Trial, experiment
from cogmap.plots import plot_cell_types


class WalkPair(NamedTuple):
    """How the animal walks while it learns, and while it is scored."""

    learnt: Motion
    scored: Motion
    shuffled: bool = False
    """Whether the views are learnt in random order."""


WALKS = {
    "brownian": WalkPair(Brownian(), Brownian()),
    "slow_turning": WalkPair(SlowTurning(), Brownian()),
    "corridor": WalkPair(Track(), Track()),
    "shuffled": WalkPair(Brownian(), Brownian(), shuffled=True),
}


@experiment(room="furnished", views=17_000, takes=("nose", "camera", "body", "map"))
def slow_features(conditions: Conditions) -> Result:
    """Learn the same room on four walks, by slowness and by smell.

    Slow feature analysis takes the Sanger codes of the views in their order; the fusion takes views and
    smells, and notices order only for its metric map and the offset of its compass. Each is measured on a
    fresh walk: brownian, but in the corridor where nothing else has been seen. `position_median_m` of slow
    features is read from them by the same decoder. The same cells of slow features are judged as place cells
    and as head-direction cells.
    """
    cells: dict[str, CellMetrics] = {}
    metrics: dict[str, Any] = {}
    for name, pair in WALKS.items():
        metrics[name], found = _learn(conditions, pair)
        cells |= {f"{name.replace('_', ' ')}, {kind}": measured for kind, measured in found.items()}
    table = as_one_table(cells)
    return Result(
        metrics=metrics,
        tables={"cells": table},
        figures={
            kind.replace(" ", "_"): plot_cell_types(table[table["population"].str.endswith(kind)])
            for kind in ("slow features", "fused place", "fused heading")
        },
        captions={
            "slow_features": "What each slow feature tells of place and heading, by walk",
            "fused_place": "What each place cell of the map tells of place and heading, by walk",
            "fused_heading": "What each head-direction cell of the map tells of place and heading, by walk",
        },
    )


def _learn(conditions: Conditions, pair: WalkPair) -> tuple[dict[str, Any], dict[str, CellMetrics]]:
    camera = Camera.panoramic()
    walk = conditions.explore(pair.learnt, camera)
    if pair.shuffled:
        walk = walk[np.random.default_rng(conditions.seed).permutation(len(walk))]
    trial = Trial(conditions, walk, conditions.explore(pair.scored, camera, fresh=True))
    learnt, slow = slow_cells(trial.codes[0], *trial.codes, seed=conditions.seed)
    cells = trial.truth.measure(slow.rates)
    position = trial.truth.position(learnt.features, slow.features)
    metrics = {
        "slow_features": {**cells.place_figures, **cells.heading_figures, **position},
        "fused": {**trial.figures, **trust_report(trial.cmap)},
    }
    return metrics, {"slow features": cells, "fused place": trial.place, "fused heading": trial.heading}
