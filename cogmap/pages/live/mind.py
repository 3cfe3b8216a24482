"""The mind: what a map makes of what is sensed, with no pose told."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float, Float32, Int, UInt8

from cogmap.control import MotorModel, Reacher
from cogmap.graph.affine_weights import affine_weights
from cogmap.imagination import Imagination
from cogmap.imagination.imagination import as_pixels
from cogmap.imagination.painter import Painter
from cogmap.imagination.places import RememberedPlaces
from cogmap.imagination.stroll import stroll
from cogmap.imagination.surprise import unusual
from cogmap.map.activity import Activity
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.shape.isomap import LandmarkIsomap
from cogmap.threads import one_thread

NEAREST = 3
"""Remembered views that are shown beside the one that is seen."""
SAMPLED, SAME = 5000, 0.01
"""Remembered views that are perceived anew at the start, and how far from where the map was refined to these
may be, in units of the extent, so that the map was refined by this memory."""
SHOWN = 2500
"""Points of the embedding."""
SOURCES = 3
"""Places that a live dream is made of: half the time of the usual five."""
AROUND, RIDGE = 8, 1e-2
"""Neighbours on the embedding that a view is put between, and the ridge of their weights."""
TURN = 0.3
"""Largest turn (rad) from one dreamt view of a way to the next."""


class Dreamt(NamedTuple):
    """A view that is imagined, and how what is seen differs from it."""

    view: UInt8[np.ndarray, "height width 3"]
    unusual: Float32[np.ndarray, "height width"] | None
    """In units of what is usual there (`cogmap.imagination.surprise`); None in the dark."""


class Thought(NamedTuple):
    """What the map makes of one look, or of one sniff in the dark."""

    activity: Activity
    """Of one view."""
    dreamt: Dreamt | None
    """At the map's own estimate; None where it cannot imagine, as it says in `Mind.reason`."""
    nearest: Int[np.ndarray, "nearest"]
    """Remembered views that look most like it, none in the dark."""
    point: Float[np.ndarray, "3"] | None
    """Where it lies on the embedding."""


@dataclass(eq=False)
class Mind:
    """A map, what it remembers, and what it can do with both. It is handed images and odours, nothing else.

    Parameters
    ----------
    cmap
        A map that has learnt; what it cannot do, such as imagine before it is refined, is left out.
    memory
        Panoramas that are remembered, (views, height, width, 3).
    motor
        What commands do; without, it goes nowhere by itself.
    """

    cmap: CognitiveMap
    _: KW_ONLY
    memory: Any
    motor: MotorModel | None = None

    @cached_property
    def sample(self) -> Int[np.ndarray, "sampled"]:
        """Which remembered views are perceived anew to draw what the map knows."""
        count = self.memory.shape[0]
        return np.unique(np.linspace(0, count - 1, min(SAMPLED, count)).astype(int))

    @cached_property
    def remembered(self) -> Activity:
        """What the map perceives of the sample."""
        return self.cmap.perceive(self.memory[self.sample])

    @cached_property
    def places(self) -> RememberedPlaces:
        """Where all that is remembered was seen: as the map was refined to by these views, or perceived."""
        relaxed = self.cmap.relaxed_places_
        if relaxed is not None and len(relaxed.places_) == self.memory.shape[0]:
            known = relaxed.places_.astype(np.float64)
            apart = np.linalg.norm(known[self.sample] - self.remembered.position, axis=1)
            extent = float(np.ptp(known, axis=0).max())
            if np.median(apart) < SAME * extent:
                return RememberedPlaces(self.memory, known, relaxed.headings_.astype(np.float64))
        return RememberedPlaces.of(self.memory, self.cmap.perceive(self.memory))

    @cached_property
    def reason(self) -> str:
        """Why it does not imagine, in words; empty when it does."""
        if self.cmap.relaxed_places_ is None:
            return self.cmap.refine_reason_
        return ""

    @cached_property
    def imagination(self) -> Imagination:
        """What imagines."""
        dream = Imagination(self.cmap, memory=self.memory, sources=SOURCES)
        dream.places = self.places
        return dream

    @cached_property
    def reacher(self) -> Reacher | None:
        """What goes to goals; None without a motor model or a refined map."""
        return None if self.motor is None or self.reason else Reacher(self.cmap, self.motor)

    @cached_property
    def codes(self) -> Float32[np.ndarray, "views components"]:
        """Of all that is remembered, to tell what looks alike."""
        return np.asarray(self.cmap.encode(self.memory), np.float32)

    @cached_property
    def shown(self) -> Int[np.ndarray, "points"]:
        """Which remembered views the embedding shows."""
        count = len(self.codes)
        return np.unique(np.linspace(0, count - 1, min(SHOWN, count)).astype(int))

    @cached_property
    def embedding(self) -> Float[np.ndarray, "points 3"]:
        """The view manifold in three dimensions: Isomap of the codes, each axis by the largest's extent."""
        codes = self.codes[self.shown].astype(np.float64)
        found = LandmarkIsomap(3, landmarks=200, averaging=True).fit(codes).embedding_
        found = found - found.mean(axis=0)
        return np.asarray(found / np.abs(found).max())

    def prepare(self) -> None:
        """Make all that the first thought would wait for."""
        _ = self.embedding
        if not self.reason:
            _ = self._painter.places.tree

    def look(self, view: UInt8[np.ndarray, "height width 3"]) -> Thought:
        """Perceive a view, imagine what should be seen there, and find what is remembered of it."""
        # once for all that it calls
        with one_thread():
            return self._look(view)

    def _look(self, view: UInt8[np.ndarray, "height width 3"]) -> Thought:
        seen = self.cmap.perceive(view[None])
        code = np.asarray(self.cmap.encode(view[None]), np.float32)
        apart = self._squares - 2 * (self.codes @ code[0])
        nearest = np.argpartition(apart, NEAREST)[:NEAREST]
        nearest = nearest[np.argsort(apart[nearest])]
        near = np.argpartition(apart[self.shown], AROUND)[None, :AROUND]
        weights = affine_weights(self.codes[self.shown[near[0]]], np.arange(AROUND)[None], code, RIDGE)
        point = (weights[0, :, None] * self.embedding[near[0]]).sum(axis=0)
        dreamt = None if self.reason else self._dream(seen.position[0], float(seen.phase[0]), view)
        return Thought(seen, dreamt, nearest, point)

    def sniff(self, odour: Float32[np.ndarray, "odorants"], phase: float) -> Thought:
        """Smell in the dark, where heading (rad, in the map's frame) is what it was believed to be."""
        smelt = self.cmap.perceive(odours=odour[None])
        dreamt = None
        if not (self.reason or np.isnan(phase) or np.isnan(smelt.position).any()):
            dreamt = self._dream(smelt.position[0], phase, None)
        return Thought(smelt, dreamt, np.zeros(0, int), None)

    def way(
        self,
        view: UInt8[np.ndarray, "height width 3"],
        goal: UInt8[np.ndarray, "height width 3"],
        frames: int,
    ) -> Float[np.ndarray, "frames 3"]:
        """Plan from one view to another: poses on the way, evenly, in the map's frame and unit.

        Raises
        ------
        CogmapError
            For views of nowhere that is remembered, and where no way is known.
        """
        dream = self.imagination
        position, phase = dream.perceive(np.stack([view, goal]))
        route = dream.ways.plan(position[0], position[1])
        poses = stroll(route, step=dream.pace / 2, turn=TURN, start=float(phase[0]), end=float(phase[1]))
        chosen = np.unique(np.linspace(0, len(poses) - 1, min(frames, len(poses))).astype(int))
        return np.asarray(poses[chosen])

    def dream(self, pose: Float[np.ndarray, "3"]) -> UInt8[np.ndarray, "height width 3"]:
        """Imagine the view from a pose in the map's frame."""
        return self._dream(pose[:2], float(pose[2]), None).view

    def _dream(
        self,
        position: Float[np.ndarray, "2"],
        phase: float,
        seen: UInt8[np.ndarray, "height width 3"] | None,
    ) -> Dreamt:
        sources = self._painter.places.sources(position[None].astype(np.float64), self.imagination.sources)
        facing = np.array([phase], np.float64)
        with one_thread():
            painted = self._painter.painted(sources, facing)(0)
            view = as_pixels(painted.view)
            if seen is None:
                return Dreamt(view, None)
            turned = self._painter.painted(sources.alone(), facing, "turned")(0)
            return Dreamt(view, unusual(seen, painted, turned.view))

    @cached_property
    def _painter(self) -> Painter:
        return Painter(self.imagination.places, self.imagination.sense)

    @cached_property
    def _squares(self) -> Float32[np.ndarray, "views"]:
        return np.asarray(np.square(self.codes).sum(axis=1), np.float32)
