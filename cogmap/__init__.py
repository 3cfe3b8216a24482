"""The cognitive map, its uses and its measures."""

from cogmap import cells, features, graph, navigation, plots, shape
from cogmap.errors import CogmapError, UntrustedMapWarning
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
    "UntrustedMapWarning",
    "VisualRoadmap",
    "betti",
    "cells",
    "features",
    "graph",
    "navigation",
    "plots",
    "score",
    "shape",
    "sweep",
]
