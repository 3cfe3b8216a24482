"""The shape of a cloud of views: words, neighbours, degrees of freedom, holes, coordinates."""

from cogmap.manifold.circular import Loop, circular_coordinate
from cogmap.manifold.dimension import intrinsic_dimension
from cogmap.manifold.embeddings import Embedding, embedding
from cogmap.manifold.height import height_coordinate
from cogmap.manifold.homology import Betti, betti
from cogmap.manifold.isomap import LandmarkIsomap
from cogmap.manifold.nearest import Nearest, nearest_points
from cogmap.manifold.neighbours import Components, components, lengthen_shortcuts, neighbour_graph
from cogmap.manifold.nerve import Nerve, population_nerve
from cogmap.manifold.similarity import (
    Agreement,
    cosine_distances,
    earth_mover_distances,
    motion_distances,
    pixel_distances,
    pose_agreement,
)
from cogmap.manifold.words import BagOfWords

__all__ = [
    "Agreement",
    "BagOfWords",
    "Betti",
    "Components",
    "Embedding",
    "LandmarkIsomap",
    "Loop",
    "Nearest",
    "Nerve",
    "betti",
    "circular_coordinate",
    "components",
    "cosine_distances",
    "earth_mover_distances",
    "embedding",
    "height_coordinate",
    "intrinsic_dimension",
    "lengthen_shortcuts",
    "motion_distances",
    "nearest_points",
    "neighbour_graph",
    "pixel_distances",
    "population_nerve",
    "pose_agreement",
]
