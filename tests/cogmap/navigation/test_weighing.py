from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp

from cogmap.graph.knn import Nearest, nearest_points
from cogmap.navigation import weighing as module
from cogmap.navigation.weighing import Weighing, choose_weighing, likeness_weights


def spin(views: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Headings, and a few of 400 words for each, that are seen somewhere in a field of 90° or are not."""
    rng = np.random.default_rng(seed)
    headings, where = rng.uniform(0, 2 * np.pi, views), rng.uniform(0, 2 * np.pi, 400)
    away = np.abs(np.angle(np.exp(1j * (headings[:, None] - where))))
    return headings, ((away < np.pi / 4) & (rng.random(away.shape) < 0.6)).astype(float)


def smooth(headings: np.ndarray, noise: float) -> np.ndarray:
    """Codes that turn with the heading and its harmonics."""
    rng = np.random.default_rng(9)
    waves = np.column_stack([f(k * headings) for k in (1, 2, 3) for f in (np.cos, np.sin)])
    return waves @ rng.standard_normal((6, 60)) + noise * rng.standard_normal((len(headings), 60))


def test_a_regression_is_believed_where_codes_vary_smoothly_and_not_in_bags_of_words() -> None:
    headings, words = spin(300, 0)
    sparse = sp.csr_array(words)
    assert choose_weighing(sparse, smooth(headings, 0.03), 1e-4, "cosine").regressed
    assert choose_weighing(smooth(headings, 0.03), None, 1e-4, "euclidean").regressed
    assert not choose_weighing(sparse, None, 1e-4, "cosine").regressed
    assert not choose_weighing(words, None, 1e-4, "cosine").regressed
    assert not choose_weighing(sparse, smooth(headings, 3.0), 1e-4, "cosine").regressed


def test_more_neighbours_are_taken_where_codes_are_noisier() -> None:
    headings, words = spin(400, 1)
    few, many = (
        choose_weighing(sp.csr_array(words), smooth(headings, noise), 1e-4, "cosine").neighbours
        for noise in (0.001, 0.3)
    )
    assert few < many


def test_a_view_is_not_asked_of_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    headings, words = spin(100, 2)
    asked_of: list[tuple[np.ndarray, np.ndarray]] = []
    plain = module._misfit

    def watched(codes: np.ndarray, asked: np.ndarray, near: np.ndarray, weights: np.ndarray) -> float:
        asked_of.append((asked, near))
        assert codes.shape == (100, 30)
        return plain(codes, asked, near, weights)

    monkeypatch.setattr(module, "_misfit", watched)
    choose_weighing(sp.csr_array(words), smooth(headings, 0.1), 1e-4, "cosine")
    assert len(asked_of) == 1 + len(module.COUNTS)
    for asked, near in asked_of:
        assert len(asked) == 100
        assert not (near == asked[:, None]).any()


def test_misfit_is_noise_where_weights_are_right_whatever_they_are() -> None:
    rng = np.random.default_rng(0)
    codes, asked = 0.5 * rng.standard_normal((400, 200)), np.arange(200)
    near = rng.integers(200, 400, (200, 6))
    for weights in (np.full((200, 6), 1 / 6), np.tile([2.0, -1.0, 0.5, -0.5, 0.0, 0.0], (200, 1))):
        assert module._misfit(codes, asked, near, weights) == pytest.approx(0.25 * 200, rel=0.03)


@pytest.mark.parametrize("views", [1, 2, 3, 7])
def test_few_views_and_single_columns_are_weighed_too(views: int) -> None:
    codes = np.random.default_rng(0).random((views, 4))
    assert 1 <= choose_weighing(codes, None, 1e-4, "cosine").neighbours <= views
    assert choose_weighing(codes[:, :1], None, 1e-4, "cosine") == Weighing(regressed=True, neighbours=views)


def test_views_near_to_nothing_leave_likeness() -> None:
    assert not choose_weighing(sp.csr_array(np.eye(20)), None, 1e-4, "cosine").regressed


def test_likeness_is_that_of_squared_distances_and_noise_changes_none() -> None:
    queries, cloud = np.random.default_rng(1).random((2, 30, 3))
    near = nearest_points(cloud, 5, queries=queries)
    weights = likeness_weights(near)
    trusted = (np.square(near.distances[:, -1:]) - np.square(near.distances)) ** 8
    np.testing.assert_allclose(weights, trusted / trusted.sum(axis=1, keepdims=True))
    noisy = Nearest(near.indices, np.sqrt(np.square(near.distances) + 4))
    np.testing.assert_allclose(likeness_weights(noisy), weights, atol=1e-9)


def test_missing_neighbours_have_no_likeness_and_equal_ones_the_same() -> None:
    inf = np.inf
    indices: Any = np.array([[3, 4, 5], [3, 4, -1], [3, -1, -1], [-1, -1, -1]])
    distances = np.array([[2.0, 2, 2], [1, 1.2, inf], [0.5, inf, inf], [inf, inf, inf]])
    found = likeness_weights(Nearest(indices, distances))
    np.testing.assert_allclose(found[:3], [[1 / 3] * 3, [1, 0, 0], [1, 0, 0]])
    assert np.isnan(found[3]).all()
