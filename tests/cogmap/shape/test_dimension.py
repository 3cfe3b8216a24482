import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

from cogmap.errors import CogmapError
from cogmap.shape.dimension import intrinsic_dimension, local_dimension


def test_by_hand() -> None:
    X = np.random.default_rng(0).normal(size=(40, 3))
    apart = np.sort(cdist(X, X), axis=1)[:, 1:6]
    inverse = np.mean([sum(np.log(row[4] / row[j]) for j in range(4)) / 3 for row in apart])
    assert intrinsic_dimension(X, neighbours=5) == pytest.approx(1 / inverse)


@given(st.integers(1, 4), st.integers(0, 100))
@settings(deadline=None, max_examples=12)
def test_tori_bent_into_twice_as_many_dimensions(dimension: int, seed: int) -> None:
    angle = np.random.default_rng(seed).uniform(0, 2 * np.pi, size=(4000, dimension))
    X = np.hstack([np.cos(angle), np.sin(angle)])
    assert intrinsic_dimension(X, neighbours=30) == pytest.approx(dimension, abs=0.15 * dimension)


def test_noise_is_looked_past() -> None:
    rng = np.random.default_rng(1)
    angle = rng.uniform(0, 2 * np.pi, 5000)
    X = np.column_stack([np.cos(angle), np.sin(angle)]) + rng.normal(scale=0.004, size=(5000, 2))
    assert intrinsic_dimension(X) == pytest.approx(1, abs=0.2)
    assert intrinsic_dimension(X, neighbours=10) > 1.5


def test_scale_turn_and_repeats_change_nothing() -> None:
    rng = np.random.default_rng(2)
    X = rng.uniform(size=(500, 3))
    turn = np.linalg.qr(rng.normal(size=(7, 3)))[0]
    same = np.concatenate([1e3 * X @ turn.T, 1e3 * X[:50] @ turn.T])
    assert intrinsic_dimension(same) == pytest.approx(intrinsic_dimension(X), abs=1e-3)


@pytest.mark.parametrize(
    ("X", "neighbours", "message"),
    [
        (np.zeros((200, 2)), 100, "1 distinct points"),
        (np.eye(100), 100, "100 distinct points are too few for 100"),
        (np.eye(20), 2, "neighbours is 2"),
        (np.full((20, 2), np.nan), 3, "NaN"),
    ],
)
def test_bad_input_gets_one_sentence(X: np.ndarray, neighbours: int, message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        intrinsic_dimension(X, neighbours=neighbours)


@given(st.integers(1, 3), st.integers(0, 100))
@settings(deadline=None, max_examples=4)
def test_directions_of_bent_tori(dimension: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, 2 * np.pi, size=(800 * dimension**2, dimension))
    X = np.hstack([np.cos(angle), np.sin(angle), rng.normal(scale=1e-3, size=(len(angle), 3))])
    found = local_dimension(X)
    assert found.dimension == dimension
    assert found.vote > 0.6
    assert found.spectrum[0] == found.spectrum.max() < 1


def test_spectrum_by_hand() -> None:
    X = np.random.default_rng(3).normal(size=(30, 4))
    near = np.argsort(cdist(X, X), axis=1)[:, :8]
    spectra = np.array([np.sort(np.linalg.eigvalsh(np.cov(X[row].T)))[::-1] for row in near])
    spectra /= spectra.sum(axis=1, keepdims=True)
    votes = np.bincount((spectra[:, :-1] / spectra[:, 1:]).argmax(axis=1))
    found = local_dimension(X, neighbours=7)
    assert found.dimension == votes.argmax() + 1
    assert found.vote == pytest.approx(votes.max() / 30)
    np.testing.assert_allclose(found.spectrum, np.median(spectra, axis=0))


def test_a_line_without_width_is_one() -> None:
    line = np.linspace(0, 1, 50)[:, None] * [1.0, 2.0, 3.0]
    assert local_dimension(line) == (1, 1.0, pytest.approx([1, 0, 0], abs=1e-8))
