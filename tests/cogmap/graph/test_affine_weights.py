import numpy as np
import pytest
from sklearn.linear_model import Ridge

from cogmap.graph import affine_weights as module
from cogmap.graph.affine_weights import affine_weights
from cogmap.graph.knn import nearest_points

RNG = np.random.default_rng(0)
CODES, QUERIES = RNG.normal(size=(80, 5)), 0.3 * RNG.normal(size=(30, 5))
NEAR = nearest_points(CODES, 12, queries=QUERIES).indices


def test_weights_are_those_of_scikit_learns_ridge_regression() -> None:
    values = RNG.normal(size=(80, 2))
    found = np.einsum("qk,qkc->qc", affine_weights(CODES, NEAR, QUERIES, 0.05), values[NEAR])
    for query, near, mine in zip(QUERIES, NEAR, found, strict=True):
        spread = np.square(CODES[near] - CODES[near].mean(axis=0)).sum()
        trusted = Ridge(alpha=0.05 * spread).fit(CODES[near], values[near])
        np.testing.assert_allclose(mine, trusted.predict(query[None])[0], atol=1e-9)


def test_they_sum_to_one_and_make_up_the_query() -> None:
    weights = affine_weights(CODES, NEAR, QUERIES, 1e-9)
    np.testing.assert_allclose(weights.sum(axis=1), 1, atol=1e-9)
    np.testing.assert_allclose(np.einsum("qk,qkc->qc", weights, CODES[NEAR]), QUERIES, atol=1e-6)


def test_missing_neighbours_weigh_nothing() -> None:
    some = NEAR.copy()
    some[:, 8:] = -1
    some[0] = -1
    weights = affine_weights(CODES, some, QUERIES, 0.01)
    assert np.isnan(weights[0]).all()
    assert (weights[1:, 8:] == 0).all()
    np.testing.assert_allclose(weights[1:, :8], affine_weights(CODES, NEAR[1:, :8], QUERIES[1:], 0.01))


def test_equal_codes_weigh_equally() -> None:
    np.testing.assert_allclose(affine_weights(np.ones((9, 5)), NEAR[:3, :4] % 9, QUERIES[:3], 0.01), 0.25)


def test_blocks_of_queries_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = affine_weights(CODES, NEAR, QUERIES, 0.01)
    monkeypatch.setattr(module, "BLOCK", 7)
    np.testing.assert_allclose(affine_weights(CODES, NEAR, QUERIES, 0.01), whole, atol=1e-12)
