"""Finding where one is, and a way to elsewhere, among remembered views; no layer here is told a pose."""

from cogmap.navigation.deviation import Deviation, path_deviation
from cogmap.navigation.image_codes import image_codes
from cogmap.navigation.localise import Localiser, Location
from cogmap.navigation.panorama import PanoramaCode
from cogmap.navigation.roadmap import VisualRoadmap

__all__ = [
    "Deviation",
    "Localiser",
    "Location",
    "PanoramaCode",
    "VisualRoadmap",
    "image_codes",
    "path_deviation",
]
