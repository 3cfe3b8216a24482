"""Intrinsic dimension: how many degrees of freedom a cloud has."""

import numpy as np
from jaxtyping import Float
from scipy.spatial import KDTree

from cogmap.errors import CogmapError
from cogmap.graph.points import checked_cloud
from cogmap.inputs import checked_count


def intrinsic_dimension(X: Float[np.ndarray, "points features"], *, neighbours: int = 100) -> float:
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
        Points.
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
