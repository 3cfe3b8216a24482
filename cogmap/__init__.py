"""The cognitive map, its uses and its measures; each is imported at its first use (PEP 562, lazy loading)."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cogmap import cells, evaluation, features, graph, navigation, plots, shape, testing
    from cogmap.checking import Checked, check
    from cogmap.control import MotorModel, PostureReacher, Reacher
    from cogmap.coordinates import GeneralisedCoordinates
    from cogmap.errors import (
        CogmapError,
        OpenSeamWarning,
        SeparatePiecesWarning,
        UnlikeArithmeticWarning,
        UntrustedMapWarning,
    )
    from cogmap.evaluation.scoring import score
    from cogmap.features import BagOfWords
    from cogmap.growing import grow
    from cogmap.imagination import Imagination
    from cogmap.map.activity import Activity
    from cogmap.map.cognitive_map import CognitiveMap
    from cogmap.map.even_memory import EvenMemory
    from cogmap.navigation import Localiser, VisualRoadmap
    from cogmap.shape import Betti, LandmarkIsomap, betti
    from cogmap.sweeps import Plan, sweep

__all__ = [
    "Activity",
    "BagOfWords",
    "Betti",
    "Checked",
    "CogmapError",
    "CognitiveMap",
    "EvenMemory",
    "GeneralisedCoordinates",
    "Imagination",
    "LandmarkIsomap",
    "Localiser",
    "MotorModel",
    "OpenSeamWarning",
    "Plan",
    "PostureReacher",
    "Reacher",
    "SeparatePiecesWarning",
    "UnlikeArithmeticWarning",
    "UntrustedMapWarning",
    "VisualRoadmap",
    "betti",
    "cells",
    "check",
    "evaluation",
    "features",
    "graph",
    "grow",
    "navigation",
    "plots",
    "score",
    "shape",
    "sweep",
    "testing",
]

_HOMES = {
    "checking": ("Checked", "check"),
    "control": ("MotorModel", "PostureReacher", "Reacher"),
    "coordinates": ("GeneralisedCoordinates",),
    "errors": (
        "CogmapError",
        "OpenSeamWarning",
        "SeparatePiecesWarning",
        "UnlikeArithmeticWarning",
        "UntrustedMapWarning",
    ),
    "evaluation.scoring": ("score",),
    "features": ("BagOfWords",),
    "growing": ("grow",),
    "imagination": ("Imagination",),
    "map.activity": ("Activity",),
    "map.cognitive_map": ("CognitiveMap",),
    "map.even_memory": ("EvenMemory",),
    "navigation": ("Localiser", "VisualRoadmap"),
    "shape": ("Betti", "LandmarkIsomap", "betti"),
    "sweeps": ("Plan", "sweep"),
}
"""Modules, with what is imported from them; what has no home is a module."""


def __getattr__(name: str) -> object:
    """Import what is asked for: who grows a map waits for no plots, and who plots for no homology."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{home}"), name)
    return import_module(f"{__name__}.{name}")


def __dir__() -> list[str]:
    return sorted(globals().keys() | __all__)
