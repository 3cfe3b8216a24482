import numpy as np
import pytest
import scipy.sparse as sp
from sklearn.linear_model import Ridge

from cogmap.errors import CogmapError
from cogmap.navigation.localise import Localiser


def plane(n: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Places, and codes that are an affine function of them."""
    places = rng.uniform(-1, 1, (n, 2))
    return places, places @ rng.standard_normal((2, 30)) + rng.standard_normal(30)


def test_weights_are_those_of_scikit_learns_ridge_regression() -> None:
    rng = np.random.default_rng(0)
    codes, places, asked = rng.standard_normal((40, 12)), rng.standard_normal((40, 3)), rng.random((5, 12))
    found = Localiser(codes, neighbours=40, ridge=0.1, metric="euclidean").locate(asked)
    spread = 40 * codes.var(axis=0).sum()
    mine = (found.weights[:, :, None] * places[found.indices]).sum(axis=1)
    trusted = Ridge(alpha=0.1 * spread).fit(codes, places).predict(asked)
    np.testing.assert_allclose(mine, trusted, atol=1e-8)


def test_on_a_plane_places_are_exact_and_weights_sum_to_one() -> None:
    rng = np.random.default_rng(1)
    places, codes = plane(500, rng)
    known, asked = slice(0, 450), slice(450, None)
    found = Localiser(codes[known], neighbours=10, ridge=1e-9, metric="euclidean").locate(codes[asked])
    np.testing.assert_allclose(found.weights.sum(axis=1), 1, atol=1e-9)
    read = (found.weights[:, :, None] * places[known][found.indices]).sum(axis=1)
    np.testing.assert_allclose(read, places[asked], atol=1e-5)


def test_neighbours_come_from_the_features_and_weights_from_the_codes() -> None:
    rng = np.random.default_rng(2)
    places, codes = plane(200, rng)
    words = sp.csr_array(np.maximum(0, 1 - 2 * np.abs(places[:, :1] - np.linspace(-1, 1, 20))))
    found = Localiser(words[:150], codes=codes[:150], neighbours=30).locate(words[150:], codes=codes[150:])
    away = np.abs(places[:150, 0][found.indices] - places[150:, :1])
    assert np.median(away) < 0.3
    read = (found.weights[:, :, None] * places[:150][found.indices]).sum(axis=1)
    assert np.median(np.linalg.norm(read - places[150:], axis=1)) < 0.01


def test_a_remembered_view_is_found_among_equals() -> None:
    codes = np.ones((5, 4))
    found = Localiser(codes, neighbours=3, metric="euclidean").locate(codes[:1])
    np.testing.assert_allclose(found.weights, 1 / 3)


def test_one_view_is_all_there_is() -> None:
    found = Localiser(np.ones((1, 4))).locate(np.array([[1.0, 2, 3, 4]]))
    assert found.indices.tolist() == [[0]]
    np.testing.assert_allclose(found.weights, 1)


def test_what_is_near_to_nothing_has_no_place() -> None:
    words = sp.csr_array(np.eye(4))
    codes = np.arange(8.0).reshape(4, 2)
    asked = sp.csr_array(np.array([[0.0, 0, 0, 0], [1, 1, 0, 0]]))
    found = Localiser(words, codes=codes, neighbours=3).locate(asked, codes=codes[:2])
    assert (found.indices[0] == -1).all()
    assert np.isnan(found.weights[0]).all()
    assert found.indices[1, 2] == -1
    assert found.weights[1, 2] == 0
    np.testing.assert_allclose(found.weights[1].sum(), 1)


def test_faults_are_named() -> None:
    codes = np.eye(4)
    with pytest.raises(CogmapError, match="or of neither"):
        Localiser(codes).locate(codes, codes=codes)
    with pytest.raises(CogmapError, match="ridge is 0"):
        Localiser(codes, ridge=0.0).locate(codes)
    with pytest.raises(CogmapError, match="make both alike"):
        Localiser(codes, codes=codes).locate(codes, codes=codes[:, :2])
    with pytest.raises(CogmapError, match="one code per view"):
        Localiser(codes, codes=codes[:2]).locate(codes, codes=codes)
