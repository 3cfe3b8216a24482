"""Reaching: going by sight alone to where an image was taken, and looking where it looks."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cogmap.control.motor_model import MotorModel
from cogmap.control.percept import MapPercept
from cogmap.control.reaching import Reaching
from cogmap.control.steering import Steering
from cogmap.inputs import checked_views
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.map.even_memory import EvenMemory
from cogmap.navigation.place_graph import PlaceGraph


@dataclass(eq=False)
class Reacher:
    """Reaches goals that are given by images, from a map, a memory and a motor model.

    Parameters
    ----------
    cmap
        A refined map (`CognitiveMap.refine`) with a metric map and a compass.
    motor
        What commands do, learnt with the same map.
    memory
        Panoramas of places where the body can be, or an `EvenMemory` of such; None takes those by which the
        map was refined.
    """

    cmap: CognitiveMap
    motor: MotorModel
    _: KW_ONLY
    memory: Any = None

    def towards(self, goal: Any) -> Reaching:
        """Make a policy that goes where an image was taken, and looks as it does.

        Parameters
        ----------
        goal
            (height, width, 3) uint8, or (explorers, height, width, 3), one for each explorer of a batch.

        Raises
        ------
        CogmapError
            For a map that is not refined, a goal of another camera or of nowhere that is remembered, and a
            motor model of commands that do nothing.
        """
        goal = np.asarray(goal)
        views = goal[None] if goal.ndim == 3 else goal
        views = checked_views(views, self.cmap.view_shape_)
        single = goal.ndim == 3
        return Reaching(MapPercept(self.cmap), self.ways, self.steering, views, single=single)

    @cached_property
    def ways(self) -> PlaceGraph:
        """What plans ways over remembered places."""
        if self.memory is None:
            return PlaceGraph(MapPercept(self.cmap).relaxed.places_)
        views = self.memory.views_ if isinstance(self.memory, EvenMemory) else self.memory
        return PlaceGraph(self.cmap.perceive(views).position.astype(np.float64))

    @cached_property
    def steering(self) -> Steering:
        """How to go and turn."""
        return Steering(self.motor)
