"""The shape of a cloud of points: holes, degrees of freedom, coordinates."""

from cogmap.shape.circular import Loop, Loops, circular_coordinate, circular_coordinates
from cogmap.shape.cylinder_coordinate import height_coordinate
from cogmap.shape.dimension import LocalDimension, intrinsic_dimension, local_dimension
from cogmap.shape.embeddings import Embedding, embedding
from cogmap.shape.homology import Betti, betti
from cogmap.shape.isomap import LandmarkIsomap
from cogmap.shape.lattice import short_basis
from cogmap.shape.nerve import Nerve, population_nerve

__all__ = [
    "Betti",
    "Embedding",
    "LandmarkIsomap",
    "LocalDimension",
    "Loop",
    "Loops",
    "Nerve",
    "betti",
    "circular_coordinate",
    "circular_coordinates",
    "embedding",
    "height_coordinate",
    "intrinsic_dimension",
    "local_dimension",
    "population_nerve",
    "short_basis",
]
