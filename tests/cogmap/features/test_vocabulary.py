import cv2
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.distance import cdist
from sklearn.cluster import KMeans

from cogmap.features.vocabulary import CHUNK, EXAMPLES, learn_words, nearest_words


def blobs(n: int, rng: np.random.Generator) -> np.ndarray:
    centres = rng.uniform(-10, 10, size=(12, 5))
    return (centres[rng.integers(12, size=n)] + rng.normal(scale=0.1, size=(n, 5))).astype(np.float32)


@given(st.integers(0, 10_000), st.sampled_from([1, 40, CHUNK - 1, CHUNK, CHUNK + 1]))
def test_nearest_words_are_the_nearest(seed: int, spots: int) -> None:
    rng = np.random.default_rng(seed)
    values, words = rng.normal(size=(spots, 6)).astype(np.float32), rng.normal(size=(9, 6)).astype(np.float32)
    apart = cdist(values, words)
    found = nearest_words(values, words)
    np.testing.assert_allclose(apart[np.arange(spots), found], apart.min(axis=1), atol=1e-5)


def test_words_are_cluster_centres() -> None:
    X = blobs(3000, np.random.default_rng(0))
    words = learn_words(X, 40, seed=0)
    assert words.shape == (40, 5)
    spread = cdist(X, words).min(axis=1) ** 2
    assert spread.mean() < 1.2 * KMeans(40, n_init=1, random_state=0).fit(X).inertia_ / len(X)


def test_seed_decides_to_the_bit() -> None:
    X = blobs(2000, np.random.default_rng(1))
    one = learn_words(X, 30, seed=2**40)
    np.testing.assert_array_equal(one, learn_words(X, 30, seed=2**40))
    assert not np.array_equal(one, learn_words(X, 30, seed=1))
    cv2.setNumThreads(1)
    try:
        np.testing.assert_array_equal(one, learn_words(X, 30, seed=2**40))
    finally:
        cv2.setNumThreads(-1)


def test_fewer_descriptors_than_words() -> None:
    X = np.repeat(np.eye(3, dtype=np.float32), 20, axis=0)
    np.testing.assert_array_equal(np.sort(learn_words(X, 3, seed=0), axis=0), np.sort(np.eye(3), axis=0))
    assert len(learn_words(X, 50, seed=0)) == 3
    assert learn_words(np.empty((0, 7), np.float32), 50, seed=0).shape == (0, 7)


def test_of_many_descriptors_some_are_clustered() -> None:
    X = np.arange(4 * EXAMPLES, dtype=np.float32)[:, None]
    words = learn_words(X, 2, seed=0)
    np.testing.assert_allclose(np.sort(words.ravel()), [EXAMPLES, 3 * EXAMPLES], rtol=0.02)
