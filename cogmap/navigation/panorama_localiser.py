"""Localisation of panoramas: where they were taken, and by how much remembered ones must be turned."""

from __future__ import annotations

from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float, Int

from cogmap.errors import CogmapError
from cogmap.features.panorama import PanoramaCode
from cogmap.features.seam import wraps_around
from cogmap.features.strips import strips
from cogmap.graph.knn import Nearest, PointSearch, nearest_points
from cogmap.inputs import checked_views
from cogmap.navigation.weighing import Weighing, choose_weighing, likeness_weights

RIDGE = 1e-4
"""Of the affine weights."""
EQUAL = 1e-6
"""Distance of the codes of equal views, which rounding makes, in standard deviations of all."""


class TurnedLocation(NamedTuple):
    """Remembered panoramas near to each query, how much of each makes it up, and by how much each is turned.

    Who knows positions (m) and headings (rad) of the remembered views has those of the queries::

        position = np.einsum("qk,qkc->qc", weights, positions[indices])
        heading = np.angle((turn_weights * np.exp(1j * (headings[indices] + turns))).sum(axis=1))
    """

    indices: Int[np.ndarray, "queries neighbours"]
    """The nearest first."""
    weights: Float[np.ndarray, "queries neighbours"]
    """They sum to one, and may be negative."""
    turns: Float[np.ndarray, "queries neighbours"]
    """By how much to turn left from each remembered view to look as the query does, rad in (−π, π]."""
    turn_weights: Float[np.ndarray, "queries neighbours"]
    """How far each turn counts: the more, the nearer. They sum to one, and none is negative: errors of turns
    grow too unevenly with distance for affine weights to cancel them."""
    novelty: Float[np.ndarray, "queries"]
    """How unlike the query is to what the weights make up, or to the nearest view once turned, over what is
    usual among remembered views: about 1 where it is known, and several where nothing like it is remembered
    and the weights mean no place."""


class _Usual(NamedTuple):
    """Medians over remembered views, each placed among the others."""

    missed: float
    """Distance of its code from what the weights make up."""
    unlike: float
    """Misfit of the nearest, once turned to it."""


class PanoramaLocaliser:
    """Places panoramas among remembered ones, whichever way they look.

    Neighbours are those that look alike from any heading, and weights are made of the same code
    (`PanoramaCode`); the turn is told by how the columns shift (`cogmap.features.compass`).

    Parameters
    ----------
    code
        Fitted to the remembered views.
    weighing
        Of their places.
    usual
        What is usual among them.
    view_shape
        (height, width, 3) of the views.
    """

    def __init__(
        self, code: PanoramaCode, weighing: Weighing, usual: _Usual, view_shape: tuple[int, ...]
    ) -> None:
        self.code, self.weighing, self.usual, self.view_shape = code, weighing, usual, view_shape

    @classmethod
    def remember(cls, views: Any) -> PanoramaLocaliser:
        """Remember panoramas, (views, height, width, 3) uint8, in any order.

        Raises
        ------
        CogmapError
            For views that do not look all around, as those themselves tell, or are all alike.
        """
        views = checked_views(views)
        if not wraps_around(views):
            raise CogmapError(
                "the last column of these views does not continue in the first, so that turning does not "
                "shift them; give panoramas that look all around, or features of the views to `Localiser`"
            )
        code = PanoramaCode().fit(views)
        weighing = choose_weighing(code.places_, None, RIDGE, "euclidean")
        near = nearest_points(code.places_, min(weighing.neighbours, len(code.places_) - 1))
        weights = weighing.weigh(near, code.places_, code.places_, RIDGE)
        nearest = np.column_stack([np.arange(len(near.indices)), near.indices[:, 0]])
        # where a robot stood still, views may be equal
        different = near.distances[:, 0] > EQUAL
        usual = _Usual(
            float(np.median(_missed(code, near, weights, code.places_)[different])),
            float(np.median(code.compare_known(nearest[different]).misfit)),
        )
        return cls(code, weighing, usual, tuple(views.shape[1:]))

    def locate(self, views: Any) -> TurnedLocation:
        """Place panoramas, (queries, height, width, 3) uint8.

        Raises
        ------
        CogmapError
            For views of another shape than the remembered ones.
        """
        views = checked_views(views)
        if tuple(views.shape[1:]) != self.view_shape:
            raise CogmapError(
                f"views are of shape {tuple(views.shape[1:])} but remembered ones of {self.view_shape}; "
                "give views of one camera"
            )
        seen = strips(views)
        places = self.code.place(seen)
        near = self._search(self.weighing.neighbours, places)
        weights = self.weighing.weigh(near, self.code.places_, places, RIDGE)
        turned, unlike = self.code.turn(seen, near.indices)
        missed = _missed(self.code, near, weights, places) / self.usual.missed
        novelty = np.maximum(missed, np.sqrt(unlike / self.usual.unlike))
        return TurnedLocation(near.indices, weights, turned, likeness_weights(near), novelty)

    @cached_property
    def _search(self) -> PointSearch:
        return PointSearch(self.code.places_)


def _missed(
    code: PanoramaCode,
    near: Nearest,
    weights: Float[np.ndarray, "queries neighbours"],
    places: Float[np.ndarray, "queries components"],
) -> Float[np.ndarray, "queries"]:
    """Give how far codes are from what the weights make up."""
    made = np.einsum("qk,qkc->qc", weights, code.places_[near.indices])
    return np.asarray(np.linalg.norm(places - made, axis=1))
