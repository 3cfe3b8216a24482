"""Localisation: where a view was taken, in terms of remembered views."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int

from cogmap.errors import CogmapError
from cogmap.graph.knn import Metric, nearest_points
from cogmap.graph.points import AnyCloud, checked_cloud
from cogmap.inputs import AnyArray, Whole, checked_count
from cogmap.navigation.panorama_localiser import PanoramaLocaliser
from cogmap.navigation.weighing import Weighing, choose_weighing


class Location(NamedTuple):
    """Remembered views near to each query, and how much of each makes up the query."""

    indices: Int[np.ndarray, "queries neighbours"]
    """The nearest first; −1 where there are no more."""
    weights: Float[np.ndarray, "queries neighbours"]
    """They sum to one, and may be negative; 0 where there is no view, NaN where there is none at all."""


@dataclass(eq=False)
class Localiser:
    """Places views among remembered ones by affine weights; whatever these say of themselves interpolates.

    Views with similar `features`, such as bags of words, are near, but how near features cannot say. So the
    weights are those of a ridge regression on the `codes` of the nearest views
    (`cogmap.graph.affine_weights`). Where codes are too noisy for that, as bags of words are, or remembered
    views too far apart, the nearest are weighed by how alike they are; the remembered views tell
    (`cogmap.navigation.weighing`).

    Parameters
    ----------
    features
        Of the remembered views, by which the nearest are found, (views, features), dense or sparse.
    codes
        Of the same views, `image_codes`, (views, codes); the features themselves when None. They say far more
        than bags of words do.
    neighbours
        k of the regression; all there are when these are fewer. When None, what suits the remembered views.
    ridge
        λ. Less follows noise, more stays near the middle of the neighbours.
    metric
        Of the features; "cosine" for bags of words.

    Raises
    ------
    CogmapError
        From `locate`, for arrays that are not finite or do not fit each other.
    """

    features: AnyCloud
    _: KW_ONLY
    codes: AnyArray | None = None
    neighbours: Whole | None = None
    ridge: float = 1e-4
    metric: Metric = "cosine"

    @staticmethod
    def for_panoramas(views: Any) -> PanoramaLocaliser:
        """Remember panoramas, (views, height, width, 3) uint8; places others, and tells turns.

        Raises
        ------
        CogmapError
            For views that do not look all around.
        """
        return PanoramaLocaliser.remember(views)

    @cached_property
    def weighing(self) -> Weighing:
        """How views are weighed: as told, or as suits the remembered ones."""
        features = checked_cloud(self.features)
        views = features.shape[0]
        if self.neighbours is not None:
            return Weighing(
                regressed=True, neighbours=min(checked_count("neighbours", self.neighbours), views)
            )
        known = None if self.codes is None else _codes(self.codes, views)
        return choose_weighing(features, known, self.ridge, self.metric)

    def locate(self, query: AnyCloud, *, codes: AnyArray | None = None) -> Location:
        """Place views given by their features, (queries, features), and codes if the remembered have any."""
        if (codes is None) != (self.codes is None):
            raise CogmapError("give codes of both the remembered views and the query, or of neither")
        if not self.ridge > 0:
            raise CogmapError(f"ridge is {self.ridge}; give a number above 0")
        features, query = checked_cloud(self.features), checked_cloud(query)
        train = _codes(features if self.codes is None else self.codes, features.shape[0])
        test = _codes(query if codes is None else codes, query.shape[0])
        if train.shape[1] != test.shape[1]:
            raise CogmapError(
                f"codes of the query have {test.shape[1]} features but those of the views {train.shape[1]}; "
                "make both alike"
            )
        near = nearest_points(features, self.weighing.neighbours, queries=query, metric=self.metric)
        return Location(near.indices, self.weighing.weigh(near, train, test, self.ridge))


def _codes(codes: AnyCloud, views: int) -> Float[np.ndarray, "views codes"]:
    checked = checked_cloud(codes)
    if checked.shape[0] != views:
        raise CogmapError(f"there are {checked.shape[0]} codes but {views} views; give one code per view")
    return np.asarray(checked.toarray() if sp.issparse(checked) else checked)
