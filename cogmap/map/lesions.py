"""Lesions: the state of a map by the names it is saved under, and copies with some of it changed."""

from collections.abc import Mapping
from copy import deepcopy

import numpy as np
import torch
from jaxtyping import Float, Int
from torch import Tensor

from cogmap.map.cognitive_map import CognitiveMap
from neurons.layers.afferents import Afferents


def weights_of(cmap: CognitiveMap) -> dict[str, Tensor]:
    """Copy all that a map has learnt to the processor, by the names it is saved under."""
    return {name: weight.to("cpu", copy=True) for name, weight in cmap.state_dict().items()}


def with_state(cmap: CognitiveMap, changed: Mapping[str, Tensor]) -> CognitiveMap:
    """Copy a map, but for these weights."""
    other = deepcopy(cmap)
    learnt = other.state_dict()
    for name, weight in changed.items():
        learnt[name].copy_(weight)
    return other


def with_blank_afferents(cmap: CognitiveMap) -> CognitiveMap:
    """Copy a map whose cells hear nothing yet: their afferents from sight are as before any view."""
    learnt = cmap.state_dict()
    blank = {name: torch.zeros_like(learnt[name]) for name in learnt if ".afferents." in name}
    return with_state(cmap, blank)


def lesioned(cmap: CognitiveMap, charts: Int[np.ndarray, "silent"]) -> CognitiveMap:
    """Copy a map in which these charts are never active, and others take their place; nothing is relearnt."""
    centres = weights_of(cmap)["charts.centres"]
    centres[torch.from_numpy(charts)] = 1e6  # in every component: no view comes near it
    return with_state(cmap, {"charts.centres": centres})


def afferent_weights(cmap: CognitiveMap, cells: str) -> Float[np.ndarray, "charts cells"]:
    """Give W in Hz from every chart to every cell of the population "place" or "heading"."""
    learnt = weights_of(cmap)
    sums = {name: learnt[f"{cells}.afferents.{name}"] for name in ("association", "activity")}
    afferents = Afferents(*sums["association"].shape)
    afferents.load_state_dict(sums)
    return np.asarray(afferents.weights.numpy())
