"""Finding where one is, and a way to elsewhere, among remembered views; no layer here is told a pose."""

from cogmap.features.image_codes import image_codes
from cogmap.features.panorama import PanoramaCode
from cogmap.navigation.localise import Localiser, Location
from cogmap.navigation.roadmap import VisualRoadmap

__all__ = ["Localiser", "Location", "PanoramaCode", "VisualRoadmap", "image_codes"]
