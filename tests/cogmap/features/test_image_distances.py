import numpy as np
import ot
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.metrics.pairwise import cosine_distances as their_cosine_distances

from cogmap.errors import CogmapError
from cogmap.features import image_distances
from cogmap.features.image_distances import (
    cosine_distances,
    earth_mover_distances,
    pixel_distances,
)


def strips(n: int, rng: np.random.Generator, columns: int = 24) -> np.ndarray:
    return rng.integers(0, 256, size=(n, 5, columns, 3), dtype=np.uint8)


@given(st.integers(0, 1000), st.integers(2, 30))
@settings(deadline=None, max_examples=15)
def test_earth_movers_work_is_that_of_pot(seed: int, columns: int) -> None:
    rng = np.random.default_rng(seed)
    queries, views = strips(3, rng, columns), strips(4, rng, columns)
    place = np.arange(columns) / columns
    steps = np.abs(place[:, None] - place)
    ring = 2 * np.pi * np.minimum(steps, 1 - steps)
    for q, query in enumerate(queries):
        for v, view in enumerate(views):
            ours = earth_mover_distances(queries, views)[q, v]
            light = [strip.sum(axis=0, dtype=float) for strip in (query, view)]
            light = [part / part.sum(axis=0) for part in light]
            work = [ot.emd2(light[0][:, c].copy(), light[1][:, c].copy(), ring) for c in range(3)]
            assert ours == pytest.approx(np.mean(work), abs=1e-9)


def test_earth_mover_measures_a_turn() -> None:
    strip = np.zeros((1, 4, 360, 3), np.uint8)
    strip[:, :, 10:14] = 200
    for shift in (0, 1, 90, 300):
        turned = np.roll(strip, shift, axis=2)
        expected = 2 * np.pi * min(shift, 360 - shift) / 360
        assert earth_mover_distances(strip, turned)[0, 0] == pytest.approx(expected, abs=1e-9)


def test_brightness_moves_nothing_and_darkness_is_even() -> None:
    rng = np.random.default_rng(0)
    strip = strips(1, rng) // 2
    assert earth_mover_distances(strip, 2 * strip)[0, 0] == pytest.approx(0, abs=1e-12)
    dark, even = np.zeros_like(strip), np.full_like(strip, 9)
    assert earth_mover_distances(dark, even)[0, 0] == pytest.approx(0, abs=1e-12)


def test_pixels_differ_by_their_root_mean_square(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(image_distances, "PIXELS", 100)
    rng = np.random.default_rng(1)
    queries, views = strips(7, rng), strips(300, rng)
    apart = queries[:, None].astype(float) - views
    np.testing.assert_allclose(pixel_distances(queries, views), np.sqrt((apart**2).mean(axis=(2, 3, 4))))
    assert pixel_distances(np.zeros_like(queries), np.full_like(queries, 255)).max() == pytest.approx(255)


def test_words_differ_by_their_cosine() -> None:
    rng = np.random.default_rng(2)
    X = rng.uniform(size=(20, 9)) * (rng.uniform(size=(20, 9)) < 0.5)
    X[4] = 0
    X /= np.maximum(np.linalg.norm(X, axis=1, keepdims=True), 1e-9)
    rows = sp.csr_array(X, dtype=np.float32)
    np.testing.assert_allclose(cosine_distances(rows[:6], rows), their_cosine_distances(X[:6], X), atol=1e-6)
    np.testing.assert_array_equal(cosine_distances(rows[4:5], rows), 1)


@pytest.mark.parametrize("measure", [pixel_distances, earth_mover_distances])
def test_images_of_two_sizes_get_one_sentence(measure) -> None:
    rng = np.random.default_rng(4)
    with pytest.raises(CogmapError, match="give images of one size"):
        measure(strips(2, rng), strips(2, rng, 30))
    with pytest.raises(CogmapError, match="uint8 images"):
        measure(strips(2, rng).astype(float), strips(2, rng))
