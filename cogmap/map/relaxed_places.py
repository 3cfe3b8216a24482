"""Relaxed places: where views were taken, and whither, finely enough to act on."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int

from arena.angles import wrap_angle
from cogmap.errors import CogmapError
from cogmap.features.compass import turns
from cogmap.features.panorama import PanoramaCode
from cogmap.features.strips import strips
from cogmap.graph.affine_weights import affine_weights
from cogmap.graph.knn import PointSearch, nearest_points
from cogmap.map.pose_graph import PoseGraph, relax_walk

NEIGHBOURS = 60
"""Whose places make up that of a view."""
BESIDE = 10
"""Which neighbour tells what is usual."""
RIDGE = 1e-3
"""Of the affine weights."""
NORTH, STIFF = 16, 1e-2
"""Of the neighbours, which tell the heading, and the ridge of their weights."""
DRIFT = 100
"""Times that the drift of headings is averaged over neighbours, some 10 cm around, so over a metre in all."""
LOOK_ALIKE = 6.0
"""Usual distances to a neighbour beyond which a view that looks alike was taken elsewhere."""
SHIFTS = 0.99
"""Resultant of what phases turned by and panoramas are shifted by, below which turning is no shift."""


class Located(NamedTuple):
    """What relaxed places say of views."""

    position: Float[np.ndarray, "views 2"]
    """In the map's metric frame."""
    phase: Float[np.ndarray, "views"]
    """Heading in the map's frame, rad in (−π, π]."""
    novelty: Float[np.ndarray, "views"]
    """How far the farthest of its neighbours is by looks, or how unlike the nearest once turned, over what is
    usual among remembered views: about 1 where it is known, and many in another room."""


class _Usual(NamedTuple):
    """What is usual among remembered views."""

    apart: float
    """Distance by looks to the farthest neighbour."""
    reach: float
    """Distance in the map beyond which a neighbour by looks is none."""
    misfit: float
    """To a neighbour `BESIDE`."""


class RelaxedPlaces:
    """Places and headings of panoramas, from those that a map recalls of remembered ones.

    Recalled places jump by some centimetres between views of one place. Here a view lies where the affine
    weights of those that look alike from any heading (`PanoramaCode`) put it, its heading is that of its
    neighbours plus the turn between the panoramas, and both agree with the steps of the walk on which they
    were remembered, if there was one (`relax_walk`). No pose is told, and no camera: that a turn shifts the
    columns of a view is tested on the views themselves.

    Attributes
    ----------
    places_, headings_
        Of the remembered views, (views, 2) in the map's metric frame and (views,) rad.
    mirrored_
        Whether phase grows to the right.
    """

    def __init__(
        self, code: PanoramaCode, places: Float[np.ndarray, "views 2"], usual: _Usual, *, mirrored: bool
    ) -> None:
        self._code, self.places_, self._usual, self.mirrored_ = code, places, usual, mirrored

    @classmethod
    def learn(
        cls, views: Any, position: Float[np.ndarray, "views 2"], phase: Float[np.ndarray, "views"]
    ) -> RelaxedPlaces:
        """Relax what a map recalls of panoramas, best in the order of a walk.

        Parameters
        ----------
        views
            (views, height, width, 3) uint8, all of them remembered.
        position, phase
            As the map perceives them.

        Raises
        ------
        CogmapError
            For fewer views than have neighbours, and those that a turn does not shift, such as perspective
            ones: R of learnt and measured turns is told.
        """
        if len(position) <= NEIGHBOURS:
            raise CogmapError(
                f"there are {len(position)} views to relax places of; give more than {NEIGHBOURS}"
            )
        code = PanoramaCode().fit(views)
        near, apart = nearest_points(code.places_, NEIGHBOURS)
        mirrored = _mirrored(code, near[:, 0], phase)
        compass = wrap_angle(-code.headings_ if mirrored else code.headings_)
        near = _alike(near, position, position, _reach(position, near))
        weights = affine_weights(code.places_, near, code.places_, RIDGE)
        affine = _matrix(near, weights)
        # Neighbours agree on turns better than charts do on phase, but drift over the room; charts do not.
        drift = np.exp(1j * (phase.astype(np.float64) - compass))
        even = _matrix(near, (near >= 0) / (near >= 0).sum(axis=1, keepdims=True))
        for _ in range(DRIFT):
            drift = even @ drift
        places = np.asarray(affine @ (affine @ (position[:, 0] + 1j * position[:, 1])))
        poses = relax_walk(PoseGraph(places, wrap_angle(compass + np.angle(drift))), affine)
        code.headings_ = -poses.headings if mirrored else poses.headings
        relaxed = np.column_stack([poses.places.real, poses.places.imag])
        # some neighbours on: the nearest was often taken on the same spot
        pairs = np.column_stack([np.arange(len(near)), near[:, BESIDE]])[near[:, BESIDE] >= 0]
        unlike = np.median(code.compare_known(pairs).misfit)
        return cls(
            code,
            relaxed,
            _Usual(float(np.median(apart[:, -1])), _reach(relaxed, near), float(unlike)),
            mirrored=mirrored,
        )

    @property
    def headings_(self) -> Float[np.ndarray, "views"]:
        """Headings of the remembered views in the map's frame, rad."""
        return -self._code.headings_ if self.mirrored_ else self._code.headings_

    def locate(self, views: Any, recalled: Float[np.ndarray, "views 2"]) -> Located:
        """Place panoramas, given the positions that the map recalls of them.

        Views that look alike and were taken elsewhere than about there are left out.
        """
        seen = strips(views)
        codes = self._code.place(seen)
        near = self._search(NEIGHBOURS, codes)
        indices = _alike(near.indices, recalled, self.places_, self._usual.reach)
        weights = affine_weights(self._code.places_, indices, codes, RIDGE)
        position = np.einsum("vk,vkc->vc", weights, self.places_[indices])
        north = np.where(indices < 0, indices[:, :1], indices)[:, :NORTH]
        level = affine_weights(self._code.places_, north, codes, STIFF)
        heading, unlike = self._code.compare(seen, north, level)
        phase = wrap_angle(-heading if self.mirrored_ else heading)
        unusual = np.sqrt(unlike / self._usual.misfit)
        return Located(position, phase, np.maximum(near.distances[:, -1] / self._usual.apart, unusual))

    def turns(self, views: Any, others: Any) -> Float[np.ndarray, "views"]:
        """Tell by how much (rad, as phase) to turn from each view to look as another from there does."""
        pairs = np.repeat(np.arange(len(views))[:, None], 2, axis=1)
        turned = turns(strips(others).grey, pairs, strips(views).grey)
        return -turned if self.mirrored_ else turned

    def nearest(self, views: Any) -> Int[np.ndarray, "views"]:
        """Tell which remembered view looks most like each of these from any heading."""
        seen = self._code.place(strips(views))
        return self._search(1, seen).indices[:, 0]

    @cached_property
    def _search(self) -> PointSearch:
        return PointSearch(self._code.places_)

    def state(self) -> dict[str, np.ndarray]:
        """Give all that was learnt, by name."""
        own = {
            "positions": self.places_,
            "mirrored": np.array(self.mirrored_),
            "usual": np.array(self._usual),
        }
        return {**self._code.state(), **own}

    @classmethod
    def from_state(cls, state: Mapping[str, np.ndarray]) -> RelaxedPlaces:
        """Make relaxed places of what `state` gave."""
        code, usual = PanoramaCode.from_state(state), _Usual(*state["usual"].tolist())
        return cls(code, state["positions"], usual, mirrored=bool(state["mirrored"]))


def _mirrored(
    code: PanoramaCode, nearest: Int[np.ndarray, "views"], phase: Float[np.ndarray, "views"]
) -> bool:
    """Tell whether phases run the other way than the shifts of panoramas; refuse where they do neither."""
    pairs = np.column_stack([np.arange(len(nearest)), nearest])
    shifted, turned = code.compare_known(pairs).headings, phase - phase[nearest]
    with_it, against = (abs(np.exp(1j * (turned - sign * shifted)).mean()) for sign in (1, -1))
    if not max(with_it, against) >= SHIFTS:
        raise CogmapError(
            f"turning does not shift these views: shifts and learnt turns agree to R = "
            f"{max(with_it, against):.3f}, below {SHIFTS}; places are relaxed from panoramas, by a map whose "
            "heading is to be trusted"
        )
    return bool(against > with_it)


def _reach(positions: Float[np.ndarray, "views 2"], near: Int[np.ndarray, "views neighbours"]) -> float:
    """Give the distance beyond which a neighbour by looks is none."""
    apart = np.linalg.norm(positions[near] - positions[:, None], axis=2)
    return float(LOOK_ALIKE * np.median(apart))


def _alike(
    near: Int[np.ndarray, "views neighbours"],
    here: Float[np.ndarray, "views 2"],
    positions: Float[np.ndarray, "remembered 2"],
    reach: float,
) -> Int[np.ndarray, "views neighbours"]:
    """Leave out neighbours that were taken elsewhere, −1 behind the others, whose order stays.

    Where all were, all stay: such a view is nowhere near what is remembered.
    """
    there = np.linalg.norm(positions[near] - here[:, None], axis=2) <= reach
    there |= ~there.any(axis=1, keepdims=True)
    order = np.argsort(~there, axis=1, kind="stable")
    found: np.ndarray = np.where(np.take_along_axis(there, order, 1), np.take_along_axis(near, order, 1), -1)
    return found


def _matrix(
    near: Int[np.ndarray, "views neighbours"], weights: Float[np.ndarray, "views neighbours"]
) -> sp.csr_array:
    """Make the matrix that gives each view the weighted sum of what its neighbours have."""
    views, there = len(near), near >= 0
    rows = np.broadcast_to(np.arange(views)[:, None], near.shape)[there]
    return sp.csr_array((weights[there], (rows, near[there])), shape=(views, views))
