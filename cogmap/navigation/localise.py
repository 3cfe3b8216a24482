"""Localisation: where a view was taken, in terms of remembered views."""

from dataclasses import KW_ONLY, dataclass
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int

from cogmap.errors import CogmapError
from cogmap.graph.affine_weights import affine_weights
from cogmap.graph.knn import Metric, nearest_points
from cogmap.graph.points import Cloud, checked_cloud
from cogmap.inputs import checked_count


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
    (`cogmap.graph.affine_weights`).

    Parameters
    ----------
    features
        Of the remembered views, by which the nearest are found, (views, features), dense or sparse.
    codes
        Of the same views, `image_codes`, (views, codes); the features themselves when None.
    neighbours
        k; all there are when these are fewer.
    ridge
        λ. Less follows noise, more stays near the middle of the neighbours.
    metric
        Of the features; "cosine" for bags of words.

    Raises
    ------
    CogmapError
        From `locate`, for arrays that are not finite or do not fit each other.
    """

    features: Cloud
    _: KW_ONLY
    codes: Float[np.ndarray, "views codes"] | None = None
    neighbours: int = 60
    ridge: float = 1e-4
    metric: Metric = "cosine"

    def locate(self, query: Cloud, *, codes: Float[np.ndarray, "queries codes"] | None = None) -> Location:
        """Place views given by their features, (queries, features), and codes if the remembered have any."""
        if (codes is None) != (self.codes is None):
            raise CogmapError("give codes of both the remembered views and the query, or of neither")
        if not self.ridge > 0:
            raise CogmapError(f"ridge is {self.ridge}; give a number above 0")
        train = _codes(self.features if self.codes is None else self.codes, self.features.shape[0])
        test = _codes(query if codes is None else codes, query.shape[0])
        if train.shape[1] != test.shape[1]:
            raise CogmapError(
                f"codes of the query have {test.shape[1]} features but those of the views {train.shape[1]}; "
                "make both alike"
            )
        count = min(checked_count("neighbours", self.neighbours), self.features.shape[0])
        indices = nearest_points(self.features, count, queries=query, metric=self.metric).indices
        return Location(indices, affine_weights(train, indices, test, self.ridge))


def _codes(codes: Cloud, views: int) -> Float[np.ndarray, "views codes"]:
    checked = checked_cloud(codes)
    if checked.shape[0] != views:
        raise CogmapError(f"there are {checked.shape[0]} codes but {views} views; give one code per view")
    return np.asarray(checked.toarray() if sp.issparse(checked) else checked)
