"""Point clouds: one row a point, dense or sparse."""

from itertools import pairwise
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int, Num

from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, as_array, as_floats

Cloud: TypeAlias = Num[np.ndarray, "_ ..."] | sp.csr_array
"""One row per point, (points, features), as a matrix or as sparse rows."""
AnyCloud: TypeAlias = AnyArray | sp.sparray | sp.spmatrix
"""The same as people have it: whatever holds numbers, or is sparse."""
Checked: TypeAlias = Float[np.ndarray, "_ _"] | sp.csr_array
"""A cloud that `checked_cloud` has passed."""


class Distinct(NamedTuple):
    """The points of a cloud without their repeats."""

    points: Checked
    first: Int[np.ndarray, "distinct"]
    """Where each of them first occurs in the cloud."""
    same: Int[np.ndarray, "points"]
    """Which of them each point of the cloud is."""


def checked_cloud(X: AnyCloud) -> Checked:
    """Pass a finite matrix through as floats; sparse rows get canonical, and are copied if they were not.

    Raises
    ------
    CogmapError
        When X holds no numbers, has not two axes, no features, or a value that is not finite.
    """
    cloud = as_rows("the cloud", X)
    if cloud.ndim != 2 or cloud.shape[1] == 0:
        raise CogmapError(
            f"the cloud has shape {cloud.shape}; expected one row per point, (points, features)"
        )
    if not np.isfinite(cloud if isinstance(cloud, np.ndarray) else cloud.data).all():
        raise CogmapError("the cloud holds NaN or infinite values; remove those points first")
    if isinstance(cloud, np.ndarray):
        return as_floats(cloud)
    if not cloud.has_canonical_format or not cloud.data.all():
        cloud = cloud.copy()
        cloud.sum_duplicates()
        cloud.eliminate_zeros()
    return cloud if cloud.dtype in (np.float32, np.float64) else cloud.astype(np.float64)


def as_rows(name: str, X: Any) -> np.ndarray | sp.csr_array:
    """Make an array of whatever holds numbers, and sparse rows of what is sparse.

    Raises
    ------
    CogmapError
        For what holds no numbers.
    """
    sparse = sp.issparse(X)
    return sp.csr_array(X) if sparse else as_array(name, X)


def distinct(X: Checked) -> Distinct:
    """Find which points of a checked cloud repeat others."""
    if not sp.issparse(X):
        return Distinct(*np.unique(X, axis=0, return_index=True, return_inverse=True))
    rows = [X.indices[a:b].tobytes() + X.data[a:b].tobytes() for a, b in pairwise(X.indptr)]
    # Objects, as fixed-length strings would lose the zero bytes at their ends.
    _, first, same = np.unique(np.array(rows, object), return_index=True, return_inverse=True)
    return Distinct(X[first], first, same)
