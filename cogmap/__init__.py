"""The cognitive map, its uses and its measures."""

from cogmap import cells, plots
from cogmap.activity import Activity
from cogmap.cognitive_map import CognitiveMap
from cogmap.errors import CogmapError
from cogmap.manifold.homology import Betti, betti
from cogmap.scoring import score

__all__ = ["Activity", "Betti", "CogmapError", "CognitiveMap", "betti", "cells", "plots", "score"]
