"""Features of views that no pose is needed for: bags of words, codes of panoramas, distances of images."""

from cogmap.features.bag_of_words import BagOfWords
from cogmap.features.image_codes import image_codes
from cogmap.features.image_distances import cosine_distances, earth_mover_distances, pixel_distances
from cogmap.features.panorama import PanoramaCode
from cogmap.features.visual_smell import VisualSmell

__all__ = [
    "BagOfWords",
    "PanoramaCode",
    "VisualSmell",
    "cosine_distances",
    "earth_mover_distances",
    "image_codes",
    "pixel_distances",
]
