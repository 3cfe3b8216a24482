"""The shape of a cloud of points: holes, degrees of freedom, coordinates."""

from cogmap.shape.circular import Loop, circular_coordinate
from cogmap.shape.cylinder_coordinate import height_coordinate
from cogmap.shape.dimension import intrinsic_dimension
from cogmap.shape.embeddings import Embedding, embedding
from cogmap.shape.homology import Betti, betti
from cogmap.shape.isomap import LandmarkIsomap
from cogmap.shape.nerve import Nerve, population_nerve

__all__ = [
    "Betti",
    "Embedding",
    "LandmarkIsomap",
    "Loop",
    "Nerve",
    "betti",
    "circular_coordinate",
    "embedding",
    "height_coordinate",
    "intrinsic_dimension",
    "population_nerve",
]
