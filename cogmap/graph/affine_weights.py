"""Affine weights: how much of each of its neighbours makes up a point."""

import numpy as np
from jaxtyping import Float, Int
from sklearn.utils import gen_batches

from cogmap.threads import one_thread

BLOCK = 128
"""Queries weighed together."""


def affine_weights(
    codes: Float[np.ndarray, "points features"],
    indices: Int[np.ndarray, "queries neighbours"],
    queries: Float[np.ndarray, "queries features"],
    ridge: float,
) -> Float[np.ndarray, "queries neighbours"]:
    r"""Give the affine weights w, Σw = 1, that make up each query from its neighbours.

    They are those of a ridge regression on the codes of the k neighbours, whose span is the tangent space
    there. With X the codes minus their mean c̄ and q the query,

    .. math:: w = \frac{1}{k} + \frac{1}{k} X (X^\top X / k + \lambda t I)^{-1} (q - \bar c),

    where t is the total variance of the k codes. Any quantity y that varies linearly over the neighbourhood
    is then Σ w y: a regression of y on the codes, without y having been asked for.

    Parameters
    ----------
    codes
        Of the points.
    indices
        Points near each query; −1 where there are no more.
    queries
        Codes of the queries.
    ridge
        λ > 0. Less follows noise, more stays near the middle of the neighbours.

    Returns
    -------
    weights
        They may be negative; 0 where there is no neighbour, NaN where there is none at all.

    References
    ----------
    Roweis & Saul (2000), Nonlinear dimensionality reduction by locally linear embedding.
    """
    weights = np.empty(indices.shape)
    with one_thread():
        for block in gen_batches(len(indices), BLOCK):
            weights[block] = _weigh(codes, indices[block], queries[block], ridge)
    return weights


def _weigh(
    codes: Float[np.ndarray, "points features"],
    indices: Int[np.ndarray, "queries neighbours"],
    queries: Float[np.ndarray, "queries features"],
    ridge: float,
) -> Float[np.ndarray, "queries neighbours"]:
    share = (indices >= 0) / np.maximum((indices >= 0).sum(axis=1, keepdims=True), 1)
    near = codes[indices].astype(np.float64)
    mean = np.einsum("qk,qkc->qc", share, near)
    near -= mean[:, None]
    root = np.sqrt(share)
    near *= root[:, :, None]
    products = near @ near.transpose(0, 2, 1)
    spread = np.trace(products, axis1=1, axis2=2)
    # Equal codes have no spread, and then no view is more like the query than another.
    products += np.eye(len(share[0])) * (ridge * spread + (spread == 0))[:, None, None]
    sought = near @ (queries - mean)[:, :, None]
    tilt = np.linalg.solve(products, sought)[:, :, 0]
    # weights sum to one: along the root they would all grow alike, by rounding divided by the ridge
    tilt -= root * (root * tilt).sum(axis=1, keepdims=True)
    weights: np.ndarray = share + root * tilt
    weights[indices[:, 0] < 0] = np.nan
    return weights
