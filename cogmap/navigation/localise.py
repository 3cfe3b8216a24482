"""Localisation: where a view was taken, in terms of remembered views."""

from dataclasses import KW_ONLY, dataclass
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int
from sklearn.utils import gen_batches

from cogmap.errors import CogmapError
from cogmap.graph.knn import Metric, nearest_points
from cogmap.graph.points import Cloud, checked_cloud
from cogmap.inputs import checked_count
from cogmap.threads import one_thread


class Location(NamedTuple):
    """Remembered views near to each query, and how much of each makes up the query."""

    indices: Int[np.ndarray, "queries neighbours"]
    """The nearest first; −1 where there are no more."""
    weights: Float[np.ndarray, "queries neighbours"]
    """They sum to one, and may be negative; 0 where there is no view, NaN where there is none at all."""


@dataclass(eq=False)
class Localiser:
    r"""Places views among remembered ones by affine weights; whatever these say of themselves interpolates.

    Views with similar `features`, such as bags of words, are near, but how near features cannot say. So the
    weights w, Σw = 1, are those of a ridge regression on the codes c of the nearest k views, whose span is
    the tangent space of the manifold there. For a query with code q, and X the codes minus their mean c̄,

    .. math:: w = \frac{1}{k} + \frac{1}{k} X (X^\top X / k + \lambda t I)^{-1} (q - \bar c),

    where t is the total variance of the k codes. Any quantity y that varies linearly over the neighbourhood
    is then Σ w y: a regression of y on the codes, without y having been asked for.

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

    References
    ----------
    Roweis & Saul (2000), Nonlinear dimensionality reduction by locally linear embedding: affine weights.
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
        weights = np.empty(indices.shape)
        with one_thread():
            for block in gen_batches(len(indices), 128):
                weights[block] = self._weigh(train, indices[block], test[block])
        return Location(indices, weights)

    def _weigh(
        self,
        train: Float[np.ndarray, "views codes"],
        indices: Int[np.ndarray, "queries neighbours"],
        test: Float[np.ndarray, "queries codes"],
    ) -> Float[np.ndarray, "queries neighbours"]:
        share = (indices >= 0) / np.maximum((indices >= 0).sum(axis=1, keepdims=True), 1)
        near = train[indices].astype(np.float64)
        mean = np.einsum("qk,qkc->qc", share, near)
        near -= mean[:, None]
        root = np.sqrt(share)
        near *= root[:, :, None]
        products = near @ near.transpose(0, 2, 1)
        spread = np.trace(products, axis1=1, axis2=2)
        # Equal codes have no spread, and then no view is more like the query than another.
        products += np.eye(len(share[0])) * (self.ridge * spread + (spread == 0))[:, None, None]
        sought = near @ (test - mean)[:, :, None]
        tilt = np.linalg.solve(products, sought)[:, :, 0]
        # weights sum to one: along the root they would all grow alike, by rounding divided by the ridge
        tilt -= root * (root * tilt).sum(axis=1, keepdims=True)
        weights: np.ndarray = share + root * tilt
        weights[indices[:, 0] < 0] = np.nan
        return weights


def _codes(codes: Cloud, views: int) -> Float[np.ndarray, "views codes"]:
    checked = checked_cloud(codes)
    if checked.shape[0] != views:
        raise CogmapError(f"there are {checked.shape[0]} codes but {views} views; give one code per view")
    return np.asarray(checked.toarray() if sp.issparse(checked) else checked)
