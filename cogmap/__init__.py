"""The cognitive map, its uses and its measures."""

from cogmap import cells, manifold, navigation, plots
from cogmap.activity import Activity
from cogmap.cognitive_map import CognitiveMap
from cogmap.errors import CogmapError, UnlikeArithmeticWarning
from cogmap.manifold import BagOfWords, Betti, LandmarkIsomap, betti
from cogmap.navigation import Localiser, VisualRoadmap
from cogmap.scoring import score
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
    "VisualRoadmap",
    "betti",
    "cells",
    "manifold",
    "navigation",
    "plots",
    "score",
    "sweep",
]
