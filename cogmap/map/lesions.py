"""Lesions: the state of a map by the names it is saved under, and copies with some of it changed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import torch
from jaxtyping import Float, Int
from torch import Tensor

from cogmap.map.cognitive_map import CognitiveMap
from cogmap.map.storage import read_map, write_map
from neurons.layers.afferents import Afferents

FAR = 1e6
"""Where a silent chart has its centre along every component: no view comes near it."""
POPULATIONS = ("place", "heading")
SUMS = ("association", "activity")
"""What afferents keep."""


def weights_of(cmap: CognitiveMap) -> dict[str, Tensor]:
    """Give all that a map has learnt, as `save` writes it."""
    with TemporaryDirectory() as folder:
        cmap.save(Path(folder) / "map")
        return read_map(Path(folder) / "map")[0]


def with_state(cmap: CognitiveMap, changed: Mapping[str, Tensor]) -> CognitiveMap:
    """Copy a map, but for these weights."""
    with TemporaryDirectory() as folder:
        before, after = Path(folder) / "before", Path(folder) / "after"
        cmap.save(before)
        weights, settings, learnt = read_map(before)
        write_map(after, {**weights, **changed}, settings, learnt)
        return CognitiveMap.load(after)


def with_blank_afferents(cmap: CognitiveMap) -> CognitiveMap:
    """Copy a map whose cells hear nothing yet: their afferents from sight are as before any view."""
    weights = weights_of(cmap)
    names = [f"{cells}.afferents.{sums}" for cells in POPULATIONS for sums in SUMS]
    return with_state(cmap, {name: torch.zeros_like(weights[name]) for name in names})


def lesioned(cmap: CognitiveMap, charts: Int[np.ndarray, "silent"]) -> CognitiveMap:
    """Copy a map in which these charts are never active, and others take their place; nothing is relearnt."""
    centres = weights_of(cmap)["charts.centres"].clone()
    centres[torch.from_numpy(charts)] = FAR
    return with_state(cmap, {"charts.centres": centres})


def afferent_weights(cmap: CognitiveMap, cells: str) -> Float[np.ndarray, "charts cells"]:
    """Give W in Hz from every chart to every cell of the population "place" or "heading"."""
    learnt = weights_of(cmap)
    sums = {name: learnt[f"{cells}.afferents.{name}"] for name in SUMS}
    afferents = Afferents(*sums["association"].shape)
    afferents.load_state_dict(sums)
    return np.asarray(afferents.weights.numpy())
