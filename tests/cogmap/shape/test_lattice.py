import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cogmap.shape.lattice import short_basis


@given(st.integers(0, 10_000), st.integers(1, 4))
def test_basis_of_the_same_lattice(seed: int, count: int) -> None:
    vectors = np.random.default_rng(seed).normal(size=(count, count + 2))
    basis = short_basis(vectors @ vectors.T)
    assert round(abs(np.linalg.det(basis))) == 1
    lengths = np.linalg.norm(basis @ vectors, axis=1)
    assert (np.diff(lengths) >= -1e-9).all()
    assert lengths.sum() <= np.linalg.norm(vectors, axis=1).sum() + 1e-9


@pytest.mark.parametrize("seed", range(20))
def test_shortest_of_two(seed: int) -> None:
    vectors = np.random.default_rng(seed).normal(size=(2, 3)) @ np.diag([1.0, 1.0, 0.1])
    times = np.array([t for t in itertools.product(range(-30, 31), repeat=2) if any(t)])
    shortest = np.linalg.norm(times @ vectors, axis=1).min()
    basis = short_basis(vectors @ vectors.T)
    assert np.linalg.norm(basis[0] @ vectors) == pytest.approx(shortest)


def test_sheared_angles_are_put_right() -> None:
    sheared = np.array([[1.0, 0.0], [5.0, 1.0]])
    assert (abs(short_basis(sheared @ sheared.T) @ sheared) == np.eye(2)).all()
