"""Remembered places: views of a walk, where and in which direction the map perceives them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float, Float32, Int
from scipy.spatial import KDTree

from cogmap.errors import CogmapError
from cogmap.map.activity import Activity

CANDIDATES = 40
"""Nearest places that sources are chosen from."""
APART = 0.5
"""How far a source must be from the others, in units of its distance from the target."""
RIDGE = 1e-2
"""Of the affine weights, in units of the mean of their three normal equations."""

VISIT = 100
"""Views of a walk before and after one that may be of the same visit to its place."""
SAMPLED = 500
"""Places that tell what is usual."""


class Sources(NamedTuple):
    """Remembered views that a view from elsewhere is made of, the nearest first."""

    indices: Int[np.ndarray, "targets sources"]
    distances: Float[np.ndarray, "targets sources"]
    """From the target, in the unit of the map; infinite where there are no more."""
    affine: Float32[np.ndarray, "targets sources"]
    """They sum to one and may be negative: what varies linearly over places is Σ w y at the target."""
    near: Float32[np.ndarray, "targets sources"]
    """They sum to one and fall with distance, for mixing what should be equal; 0 where there are no more."""

    def alone(self) -> Sources:
        """Give the first alone."""
        ones = np.ones_like(self.affine[:, :1])
        return Sources(self.indices[:, :1], self.distances[:, :1], ones, ones)

    def second_first(self) -> Sources:
        """Give the same with the second before the first."""
        order = np.arange(self.indices.shape[1])
        order[:2] = order[:2][::-1]
        return Sources(*(part[:, order] for part in self))


@dataclass(frozen=True, eq=False)
class RememberedPlaces:
    """A memory of views in the frame of a map."""

    views: Any
    """Panoramas (views, height, width, 3), which may lie on disk."""
    position: Float[np.ndarray, "views 2"]
    """In the unit of the map."""
    phase: Float[np.ndarray, "views"]
    """Heading in the frame of the map, rad."""

    @classmethod
    def of(cls, views: Any, known: Activity) -> RememberedPlaces:
        """Remember views where they are perceived."""
        return cls(views, known.position.astype(np.float64), known.phase.astype(np.float64))

    @cached_property
    def tree(self) -> KDTree:
        """To find what is near."""
        return KDTree(self.position)

    @cached_property
    def sample(self) -> Int[np.ndarray, "sampled"]:
        """Places that tell what is usual, evenly spread over the walk.

        Raises
        ------
        CogmapError
            For a memory so small that much of it is of one visit.
        """
        if len(self.phase) < 4 * VISIT:
            raise CogmapError(
                f"{len(self.phase)} views do not tell what is usual; remember at least {4 * VISIT}"
            )
        return np.unique(np.linspace(0, len(self.phase) - 1, SAMPLED).astype(int))

    @cached_property
    def spacing(self) -> float:
        """Median distance from a place to the nearest of another visit, in the unit of the map."""
        return float(np.median(self.sources(self.position[self.sample], 1, without=self.sample).distances))

    def sources(
        self,
        position: Float[np.ndarray, "targets 2"],
        count: int,
        *,
        without: Int[np.ndarray, "targets"] | None = None,
    ) -> Sources:
        r"""Choose places around each target, and weigh them.

        A body that turns on the spot, or slides along a wall, leaves many views of nearly one place, and the
        nearest few may all be of these. So of the nearest places each is taken that is not near to one taken
        already, compared with how far it is from the target: they lie around it.

        With u the places as seen from the target and p = 1 / (|u|² + ¼ m²), where m is their mean distance,
        the affine weights are those of a regression, read off at the target:

        .. math:: w_j = p_j\,(1, u_j)\,\bigl(\textstyle\sum_i p_i (1, u_i)^\top (1, u_i) + λ\bigr)^{-1} e_1 .

        Parameters
        ----------
        position
            Of the targets, in the unit of the map.
        count
            How many sources each has at most.
        without
            A remembered view that is itself imagined, if so: it may not be used, nor any of the same visit.

        References
        ----------
        Arya & Mount (1993), Approximate nearest neighbor queries in fixed dimensions: the pruning rule.
        Cleveland (1979), Robust locally weighted regression: the affine weights.
        """
        candidates = min(CANDIDATES, len(self.position))
        asked = min(CANDIDATES + (2 * VISIT + 1) * (without is not None), len(self.position))
        # asked for as a list, also one neighbour has an axis of its own
        reach, near = (np.asarray(part) for part in self.tree.query(position, k=np.arange(1, asked + 1)))
        if without is not None:
            reach = np.where(np.abs(near - without[:, None]) <= VISIT, np.inf, reach)
            order = np.argsort(reach, axis=1, kind="stable")[:, :candidates]
            reach, near = np.take_along_axis(reach, order, axis=1), np.take_along_axis(near, order, axis=1)
        places = self.position[near]
        chosen = np.zeros((len(near), count), np.int64)
        taken = np.ones(len(near), np.int64)
        for candidate in range(1, candidates):
            if (taken == count).all():
                break
            kept = np.take_along_axis(places, chosen[:, :, None], axis=1)
            gap = np.linalg.norm(kept - places[:, candidate, None], axis=2).min(axis=1)
            free = np.isfinite(reach[:, candidate]) & (taken < count)
            fits = np.flatnonzero(free & (gap > APART * reach[:, candidate]))
            chosen[fits, taken[fits]] = candidate
            taken[fits] += 1
        there = np.arange(count) < taken[:, None]
        distances = np.where(there, np.take_along_axis(reach, chosen, axis=1), np.inf)
        offsets = np.take_along_axis(places, chosen[:, :, None], axis=1) - position[:, None]
        affine, mixing = _weights(offsets, distances)
        return Sources(np.take_along_axis(near, chosen, axis=1), distances, affine, mixing)


def _weights(
    offsets: Float[np.ndarray, "targets sources 2"], distances: Float[np.ndarray, "targets sources"]
) -> tuple[Float32[np.ndarray, "targets sources"], Float32[np.ndarray, "targets sources"]]:
    there = np.isfinite(distances)
    squares = np.where(there, distances, 0) ** 2
    mean = np.sqrt(squares.sum(axis=1) / there.sum(axis=1))[:, None] + 1e-12
    trust = there / (squares + mean**2 / 4)
    design = np.concatenate([np.ones_like(offsets[:, :, :1]), offsets / mean[:, :, None]], axis=2)
    weighed = design * trust[:, :, None]
    normal = weighed.transpose(0, 2, 1) @ design
    normal += RIDGE * np.trace(normal, axis1=1, axis2=2)[:, None, None] / 3 * np.diag([0.0, 1.0, 1.0])
    first = np.broadcast_to(np.array([[1.0], [0.0], [0.0]]), (len(normal), 3, 1))
    affine = (weighed @ np.linalg.solve(normal, first))[:, :, 0]
    near = there / (np.sqrt(squares) + 1e-3 * mean)
    return _shares(affine), _shares(near)


def _shares(weights: Float[np.ndarray, "targets sources"]) -> Float32[np.ndarray, "targets sources"]:
    return np.asarray(weights / weights.sum(axis=1, keepdims=True), np.float32)
