"""Finding where one is, and a way to elsewhere, among remembered views; no layer here is told a pose."""

from importlib import import_module
from typing import Any

from cogmap.features.image_codes import image_codes
from cogmap.features.panorama import PanoramaCode
from cogmap.navigation.localise import Localiser, Location
from cogmap.navigation.roadmap import VisualRoadmap

__all__ = ["Localiser", "Location", "PanoramaCode", "VisualRoadmap", "image_codes"]


def __getattr__(name: str) -> Any:
    """Find under their old names what is told poses, and has moved to `cogmap.evaluation`."""
    if name in ("Deviation", "path_deviation"):
        return getattr(import_module("cogmap.evaluation.deviation"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
