"""Point clouds: one row a point, dense or sparse."""

from itertools import pairwise
from typing import NamedTuple, TypeAlias

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int

from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, as_array, as_floats

Cloud: TypeAlias = AnyArray | sp.sparray | sp.spmatrix
"""One row per point, (points, features), as whatever holds numbers or as sparse rows."""
Checked: TypeAlias = Float[np.ndarray, "_ _"] | sp.csr_array
"""A cloud that `checked_cloud` has passed."""


class Distinct(NamedTuple):
    """The points of a cloud without their repeats."""

    points: Checked
    first: Int[np.ndarray, "distinct"]
    """Where each of them first occurs in the cloud."""
    same: Int[np.ndarray, "points"]
    """Which of them each point of the cloud is."""


def checked_cloud(X: Cloud) -> Checked:
    """Pass a finite matrix through as floats; sparse rows get canonical, and are copied if they were not.

    Raises
    ------
    CogmapError
        When X holds no numbers, has not two axes, no features, or a value that is not finite.
    """
    X = sp.csr_array(X) if sp.issparse(X) else as_array("the cloud", X)
    if X.ndim != 2 or X.shape[1] == 0:
        raise CogmapError(f"the cloud has shape {X.shape}; expected one row per point, (points, features)")
    if not np.isfinite(X.data if sp.issparse(X) else X).all():
        raise CogmapError("the cloud holds NaN or infinite values; remove those points first")
    if sp.issparse(X):
        if not X.has_canonical_format or not X.data.all():
            X = X.copy()
            X.sum_duplicates()
            X.eliminate_zeros()
        return X if X.dtype in (np.float32, np.float64) else X.astype(np.float64)
    return as_floats(X)


def distinct(X: Checked) -> Distinct:
    """Find which points of a checked cloud repeat others."""
    if not sp.issparse(X):
        return Distinct(*np.unique(X, axis=0, return_index=True, return_inverse=True))
    rows = [X.indices[a:b].tobytes() + X.data[a:b].tobytes() for a, b in pairwise(X.indptr)]
    # Objects, as fixed-length strings would lose the zero bytes at their ends.
    _, first, same = np.unique(np.array(rows, object), return_index=True, return_inverse=True)
    return Distinct(X[first], first, same)
