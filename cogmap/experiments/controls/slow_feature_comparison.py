"""Does it matter how the animal walks? Slow features beside the fusion, on the same views."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from arena import Brownian, Camera, Motion, Track
from arena.motions.slow_turning import SlowTurning
from cogmap.evaluation.peers.slow_features import slow_cells
from cogmap.evaluation.populations import Ground, Measured, as_one_table, grow_map, perceive, trust
from cogmap.evaluation.scoring import score
from cogmap.experiments.conditions import Setting, poses_of
from cogmap.experiments.result import Result
from cogmap.plots import plot_cell_types


class Way(NamedTuple):
    """How the animal walks while it learns, and while it is scored."""

    learnt: Motion
    scored: Motion
    shuffled: bool = False
    """Whether the views are learnt in random order."""


WALKS = {
    "brownian": Way(Brownian(), Brownian()),
    "slow_turning": Way(SlowTurning(), Brownian()),
    "corridor": Way(Track(), Track()),
    "shuffled": Way(Brownian(), Brownian(), shuffled=True),
}


def walks(setting: Setting) -> Result:
    """Learn the same room on four walks, by slowness and by smell.

    Slow feature analysis takes the Sanger codes of the views in their order; the fusion takes views and
    smells, and notices order only for its metric map and the offset of its compass. Each is measured on a
    fresh walk: brownian, but in the corridor where nothing else has been seen. `position_median_m` of slow
    features is read from them by the same decoder. The same cells of slow features are judged as place cells
    and as head-direction cells.
    """
    cells: dict[str, Measured] = {}
    metrics: dict[str, Any] = {}
    for name, way in WALKS.items():
        metrics[name], found = _learn(setting, way)
        cells |= {f"{name.replace('_', ' ')}, {kind}": measured for kind, measured in found.items()}
    table = as_one_table(cells)
    return Result(
        metrics=metrics,
        tables={"cells": table},
        figures={
            kind.replace(" ", "_"): plot_cell_types(table[table["population"].str.endswith(kind)])
            for kind in ("slow features", "fused place", "fused heading")
        },
    )


def _learn(setting: Setting, way: Way) -> tuple[dict[str, Any], dict[str, Measured]]:
    camera = Camera.panoramic()
    walk = setting.explore(way.learnt, camera)
    fresh = setting.explore(way.scored, camera, fresh=True)
    if way.shuffled:
        walk = walk[np.random.default_rng(setting.seed).permutation(len(walk))]
    known, poses = poses_of(walk), poses_of(fresh)
    ground = Ground(known, poses, known[:, :2])
    cmap = grow_map(walk, setting.map, seed=setting.seed)
    codes = [cmap.encode(one.views) for one in (walk, fresh)]
    learnt, slow = slow_cells(codes[0], *codes, seed=setting.seed)
    before, after = (perceive(cmap, one.views) for one in (walk, fresh))
    found = {
        "slow features": ground.measure(slow.rates),
        "fused place": ground.measure(after.place),
        "fused heading": ground.measure(after.heading),
    }
    metrics = {
        "slow_features": {
            **found["slow features"].place_figures,
            **found["slow features"].heading_figures,
            **ground.position(learnt.features, slow.features),
        },
        "fused": {
            **found["fused place"].place_figures,
            **found["fused heading"].heading_figures,
            **score(after, poses, train=(before, known)),
            **trust(cmap),
        },
    }
    return metrics, found
