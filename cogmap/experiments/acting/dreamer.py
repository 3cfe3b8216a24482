"""What experiments on imagination share: a trial, its dreams, and how the map lies in the room."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from arena import Camera
from cogmap.cells.decoding.decoders import (
    HeadingFrame,
    MapFrame,
    fit_heading_frame,
    fit_map_frame,
    heading_errors,
    place_map,
)
from cogmap.errors import CogmapError, UntrustedMapWarning
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.trial import Trial
from cogmap.imagination import Imagination
from cogmap.imagination.places import RememberedPlaces
from cogmap.map.activity import Activity


@dataclass(frozen=True, eq=False)
class Dreamer:
    """An animal that has learnt a room and imagines it; the truth lays its map in the room, and scores."""

    trial: Trial

    @classmethod
    def of(cls, conditions: Conditions) -> Dreamer:
        """Learn a map from a walk and relax its places.

        Raises
        ------
        CogmapError
            When the map is not to be trusted, or its places cannot be relaxed.
        """
        trial = Trial.of(conditions, camera=Camera.panoramic())
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UntrustedMapWarning)
            trial.cmap.refine(trial.walk.views)
        if trial.cmap.relaxed_places_ is None:
            raise CogmapError(f"nothing is imagined here: {trial.cmap.refine_reason_}")
        return cls(trial)

    @cached_property
    def imagination(self) -> Imagination:
        """Of all views of the walk."""
        views, known = np.asarray(self.trial.walk.views), self.trial.train
        imagination = Imagination(self.trial.cmap, memory=views)
        # what is perceived to score is remembered
        imagination.places = RememberedPlaces.of(views, known)
        return imagination

    @cached_property
    def frame(self) -> MapFrame:
        """How the map lies in the room, fitted on the training views."""
        return fit_map_frame(self.trial.train.position, self.trial.truth.train[:, :2])

    @cached_property
    def north(self) -> HeadingFrame:
        """How phases lie on true headings, fitted on the training views."""
        return fit_heading_frame(self.trial.train.phase, self.trial.truth.train[:, 2])

    def metres(self, position: Float[np.ndarray, "views 2"]) -> Float[np.ndarray, "views 2"]:
        """Lay places of the map in the room."""
        return place_map(position, self.frame)

    def asked_from_outside(
        self, poses: Float[np.ndarray, "views 3"]
    ) -> tuple[Float[np.ndarray, "views 2"], Float[np.ndarray, "views"]]:
        """Say in the map's frame where poses of the room are: position and phase."""
        back = fit_map_frame(self.trial.truth.train[:, :2], self.trial.train.position)
        phase = (poses[:, 2] - self.north.rotation) * (-1 if self.north.mirror else 1)
        return place_map(poses[:, :2], back), phase

    def apart(self, first: Activity, second: Activity) -> dict[str, Float[np.ndarray, "views"]]:
        """Columns of a table: how far two percepts lie apart, `position_m` and `heading_deg`."""
        steps = self.metres(first.position) - self.metres(second.position)
        turn = np.angle(np.exp(1j * (first.phase.astype(float) - second.phase)))
        return {"position_m": np.linalg.norm(steps, axis=1), "heading_deg": np.abs(np.rad2deg(turn))}

    def errors(
        self, seen: Activity, poses: Float[np.ndarray, "views 3"]
    ) -> dict[str, Float[np.ndarray, "views"]]:
        """Columns of a table: how far percepts are from the truth."""
        turn = heading_errors(seen.phase, poses[:, 2], self.north)
        steps = self.metres(seen.position) - poses[:, :2]
        return {"position_m": np.linalg.norm(steps, axis=1), "heading_deg": np.abs(np.rad2deg(turn))}
