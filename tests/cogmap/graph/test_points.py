import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st

from cogmap.graph.points import checked_cloud, distinct


@given(st.integers(0, 10_000))
def test_sparse_repeats_are_the_dense_ones(seed: int) -> None:
    X = np.random.default_rng(seed).integers(-1, 2, size=(30, 3)).astype(float)
    dense, sparse = distinct(X), distinct(checked_cloud(sp.csr_array(X)))
    assert len(dense.points) == sparse.points.shape[0]
    for found in (dense, sparse):
        points = found.points if isinstance(found.points, np.ndarray) else found.points.toarray()
        np.testing.assert_array_equal(points[found.same.ravel()], X)
        np.testing.assert_array_equal(points, X[found.first])
    np.testing.assert_array_equal(np.sort(dense.first), np.sort(sparse.first))


def test_sparse_rows_are_the_same_however_they_are_stored() -> None:
    tidy = sp.csr_array(np.array([[0.0, 1.0, 2.0], [0.0, 1.0, 2.0]]))
    untidy = sp.csr_array(
        (np.array([2.0, 0.5, 0.0, 0.5, 1.0, 2.0]), np.array([2, 1, 0, 1, 1, 2]), np.array([0, 4, 6]))
    )
    before = untidy.data.copy()
    assert distinct(checked_cloud(untidy)).points.shape[0] == 1
    np.testing.assert_array_equal(checked_cloud(untidy).toarray(), tidy.toarray())
    np.testing.assert_array_equal(untidy.data, before)


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.int64, np.uint8])
def test_floats_keep_their_precision(dtype: type) -> None:
    X = np.eye(4, dtype=dtype)
    wanted = dtype if np.issubdtype(dtype, np.floating) else np.float64
    assert checked_cloud(X).dtype == wanted
    assert checked_cloud(sp.csr_array(X)).dtype == wanted
