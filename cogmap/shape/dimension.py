"""Intrinsic dimension: how many degrees of freedom a cloud has."""

from typing import NamedTuple

import numpy as np
import torch
from jaxtyping import Float
from scipy.spatial import KDTree

from cogmap.errors import CogmapError
from cogmap.graph.knn import nearest_points
from cogmap.graph.points import checked_cloud
from cogmap.inputs import AnyArray, Whole, checked_count
from cogmap.threads import one_thread
from neurons.layers.dimension import dimension_votes


class LocalDimension(NamedTuple):
    """How many directions most neighbourhoods of a cloud spread in."""

    dimension: int
    vote: float
    """Share of the points whose neighbourhood says so."""
    spectrum: Float[np.ndarray, "components"]
    """Shares of variance of a neighbourhood along its principal axes, medians over the points."""


def local_dimension(X: AnyArray, *, neighbours: Whole = 15, most: Whole = 8) -> LocalDimension:
    """Find the dimension of the manifold that points lie on, by principal components of neighbourhoods.

    The variances of a point and its nearest others fall most where the directions along the manifold end and
    those of curvature and noise begin (`neurons.layers.dimension`). The dimension is what most points
    say; unlike the estimate of `intrinsic_dimension` it is a whole number, with a vote.

    Parameters
    ----------
    X
        Points, (points, features).
    neighbours
        Other points in a neighbourhood: a few times as many as there are dimensions, and few enough to lie
        flat.
    most
        The largest dimension that is looked for.

    Raises
    ------
    CogmapError
        For points that are not finite, and for too few of them.
    """
    points = np.asarray(checked_cloud(X))
    most = min(
        checked_count("most", most), checked_count("neighbours", neighbours, 2) - 1, points.shape[1] - 1
    )
    near = nearest_points(points, neighbours).indices
    shares = np.empty((len(points), most + 1))
    with one_thread():
        for block in np.array_split(np.arange(len(points)), -(-len(points) // 512)):
            around = points[np.column_stack([block, near[block]])].astype(np.float64)
            around -= around.mean(axis=1, keepdims=True)
            variances = np.square(np.linalg.svd(around, compute_uv=False))
            shares[block] = (variances / variances.sum(axis=1, keepdims=True))[:, : most + 1]
        votes = dimension_votes(torch.from_numpy(shares)).numpy()
    return LocalDimension(int(votes.argmax()) + 1, float(votes.max()), np.median(shares, axis=0))


def intrinsic_dimension(X: AnyArray, *, neighbours: Whole = 100) -> float:
    r"""Estimate the dimension of the manifold that points lie on, by maximum likelihood.

    With T_j(x) the distance from x to its j-th nearest point, the number of points within a distance grows as
    its d-th power, of which the most likely d at a point is

    .. math:: m(x)^{-1} = \frac{1}{k - 2} \sum_{j=1}^{k-1} \log \frac{T_k(x)}{T_j(x)}.

    The estimate is the inverse of the mean of 1 / m over the points. It is not a whole number, and a little
    low where many points are near a border. Bags of words lie far off their manifold, in every direction:
    estimate the dimension of their ten-dimensional `LandmarkIsomap` instead.

    Parameters
    ----------
    X
        Points, (points, features).
    neighbours
        k; 100 looks past the noise of single points.

    Raises
    ------
    CogmapError
        For points that are not finite, and for no more distinct ones than `neighbours`.

    References
    ----------
    Levina & Bickel (2004), Maximum likelihood estimation of intrinsic dimension. MacKay & Ghahramani (2005),
    Comments on it: the mean of inverses.
    """
    checked_count("neighbours", neighbours, 3)
    points = np.unique(np.asarray(checked_cloud(X)), axis=0)
    if len(points) <= neighbours:
        raise CogmapError(
            f"{len(points)} distinct points are too few for {neighbours} neighbours; "
            "give more points or ask for fewer neighbours"
        )
    lengths = np.log(KDTree(points).query(points, k=np.arange(2, neighbours + 2))[0])
    inverse = (lengths[:, -1:] - lengths[:, :-1]).sum(axis=1) / (neighbours - 2)
    return float(1 / inverse.mean())
