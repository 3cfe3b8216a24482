"""The cognitive map, its uses and its measures; each is imported at its first use (PEP 562, lazy loading)."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cogmap import cells, evaluation, features, graph, navigation, plots, shape, testing
    from cogmap.errors import CogmapError, UnlikeArithmeticWarning, UntrustedMapWarning
    from cogmap.evaluation.scoring import score
    from cogmap.features import BagOfWords
    from cogmap.map.activity import Activity
    from cogmap.map.cognitive_map import CognitiveMap
    from cogmap.navigation import Localiser, VisualRoadmap
    from cogmap.shape import Betti, LandmarkIsomap, betti
    from cogmap.sweeps import Plan, sweep

__all__ = [
    "Activity",
    "BagOfWords",
    "Betti",
    "CogmapError",
    "CognitiveMap",
    "LandmarkIsomap",
    "Localiser",
    "Plan",
    "UnlikeArithmeticWarning",
    "UntrustedMapWarning",
    "VisualRoadmap",
    "betti",
    "cells",
    "evaluation",
    "features",
    "graph",
    "navigation",
    "plots",
    "score",
    "shape",
    "sweep",
    "testing",
]

_HOMES = {
    "Activity": "map.activity",
    "BagOfWords": "features",
    "Betti": "shape",
    "CogmapError": "errors",
    "CognitiveMap": "map.cognitive_map",
    "LandmarkIsomap": "shape",
    "Localiser": "navigation",
    "Plan": "sweeps",
    "UnlikeArithmeticWarning": "errors",
    "UntrustedMapWarning": "errors",
    "VisualRoadmap": "navigation",
    "betti": "shape",
    "score": "evaluation.scoring",
    "sweep": "sweeps",
}


def __getattr__(name: str) -> object:
    """Import what is asked for: who grows a map waits for no plots, and who plots for no homology."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    if name not in _HOMES:
        return import_module(f"{__name__}.{name}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted(globals().keys() | __all__)
