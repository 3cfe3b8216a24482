"""The percept that is acted on: where views were taken, and by how much two of one place are turned."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from cogmap.errors import CogmapError
from cogmap.map.activity import Activity
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.map.relaxed_places import RelaxedPlaces

Views = Any
"""Images (views, height, width, 3) uint8, or what slices to such."""


@runtime_checkable
class Percept(Protocol):
    """Tells where views were taken."""

    def perceive(self, views: Views) -> Activity:
        """Give at least `position`, `phase` and `novelty`."""

    def turns(self, views: Views, others: Views) -> Float[np.ndarray, "views"]:
        """Tell by how much (rad, as phase) to turn from each view to look as another from there does."""


@dataclass(frozen=True)
class MapPercept:
    """The percept of a refined map.

    Turns between two views of one place are read off the views themselves, ten times finer than from the
    phases of both.

    Raises
    ------
    CogmapError
        For a map that is not refined.
    """

    cmap: CognitiveMap

    @property
    def relaxed(self) -> RelaxedPlaces:
        """What the map was refined to."""
        relaxed = self.cmap.relaxed_places_
        if relaxed is None:
            raise CogmapError(f"this map's places are too coarse to act on: {self.cmap.refine_reason_}")
        return relaxed

    def perceive(self, views: Views) -> Activity:
        """Give what the map perceives."""
        return self.cmap.perceive(views)

    def turns(self, views: Views, others: Views) -> Float[np.ndarray, "views"]:
        """Compare the views."""
        return self.relaxed.turns(views, others)
