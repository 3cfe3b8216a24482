import itertools

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from cogmap.cells.decoding.decoders import fit_heading_frame, heading_errors
from cogmap.errors import CogmapError
from cogmap.graph.neighbour_graph import SMALLEST, neighbour_graph
from cogmap.shape.circular import circular_coordinate, circular_coordinates


def resultant(phase: np.ndarray, angle: np.ndarray) -> float:
    return float(abs(np.mean(np.exp(1j * heading_errors(phase, angle, fit_heading_frame(phase, angle))))))


def noisy_ring(n: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    angle = rng.permutation(2 * np.pi * (np.arange(n) + rng.uniform(size=n)) / n - np.pi)
    X = np.column_stack([np.cos(angle), np.sin(angle), rng.normal(scale=0.05, size=(n, 2))])
    return X, angle


@given(st.integers(0, 1000))
@settings(deadline=None, max_examples=8)
def test_angle_of_a_ring(seed: int) -> None:
    X, angle = noisy_ring(500, np.random.default_rng(seed))
    found = circular_coordinate(neighbour_graph(X), seed=seed)
    assert resultant(found.phase, angle) > 0.998
    assert found.death > 3 * found.birth > 0


def test_ring_that_is_stretched_in_places() -> None:
    rng = np.random.default_rng(1)
    angle = rng.uniform(-np.pi, np.pi, 1500)
    arc = angle + 0.8 * np.sin(angle)
    X = np.column_stack([np.cos(arc), np.sin(arc)]) + rng.normal(scale=0.01, size=(1500, 2))
    phase = circular_coordinate(neighbour_graph(X)).phase
    assert resultant(phase, arc) < 0.95
    assert resultant(phase, angle) > 0.995


@pytest.mark.parametrize("dimension", [1, 2])
def test_angle_of_a_thick_ring(dimension: int) -> None:
    rng = np.random.default_rng(2)
    angle = rng.uniform(-np.pi, np.pi, 2500)
    X = np.column_stack([np.cos(angle), np.sin(angle), rng.uniform(-0.5, 0.5, size=(2500, dimension))])
    assert resultant(circular_coordinate(neighbour_graph(X)).phase, angle) > 0.995


def test_largest_loop_is_taken() -> None:
    rng = np.random.default_rng(3)
    large, small = rng.uniform(-np.pi, np.pi, size=(2, 3000))
    thick = 1 + 0.25 * np.cos(small)
    X = np.column_stack([thick * np.cos(large), thick * np.sin(large), 0.25 * np.sin(small)])
    assert resultant(circular_coordinate(neighbour_graph(X)).phase, large) > 0.99


def test_points_lie_evenly_on_the_circle() -> None:
    X, _ = noisy_ring(300, np.random.default_rng(4))
    phase = np.sort(circular_coordinate(neighbour_graph(X)).phase)
    np.testing.assert_allclose(np.diff(phase), 2 * np.pi / 300)
    assert -np.pi < phase[0]
    assert phase[-1] <= np.pi


def test_other_pieces_have_no_phase() -> None:
    X, angle = noisy_ring(400, np.random.default_rng(5))
    both = np.concatenate([X[:100] + 50, X])
    phase = circular_coordinate(neighbour_graph(both)).phase
    assert np.isnan(phase[:100]).all()
    assert resultant(phase[100:], angle) > 0.998


def test_repeats_have_nearly_the_same_phase() -> None:
    X, _ = noisy_ring(300, np.random.default_rng(6))
    graph = neighbour_graph(np.concatenate([X, X[:30]]))
    assert graph.min() == 0
    assert graph.data.min() == SMALLEST
    phase = circular_coordinate(graph).phase
    assert np.abs(np.angle(np.exp(1j * (phase[300:] - phase[:30])))).max() < 0.1


def test_same_seed_gives_the_same() -> None:
    graph = neighbour_graph(noisy_ring(300, np.random.default_rng(7))[0])
    one, other = (circular_coordinate(graph, seed=3) for _ in range(2))
    np.testing.assert_array_equal(one.phase, other.phase)


def test_no_loop_gets_one_sentence() -> None:
    path = np.linspace(0, 1, 40)[:, None]
    with pytest.raises(CogmapError, match="no loop"):
        circular_coordinate(neighbour_graph(path, 2))
    with pytest.raises(CogmapError, match="not symmetric"):
        circular_coordinate(sp.csr_array(np.triu(np.ones((20, 20)), 1)))


def test_two_angles_of_a_torus() -> None:
    truth = np.random.default_rng(8).uniform(-np.pi, np.pi, size=(2500, 2))
    graph = neighbour_graph(np.hstack([np.cos(truth), np.sin(truth)]))
    found = circular_coordinates(graph, 2, landmarks=200)
    assert (found.deaths > 1.5 * found.births).all()
    times = [np.array(m) for m in itertools.product(range(-2, 3), repeat=2)]
    winding = [
        max(times, key=lambda m: abs(np.exp(1j * (phase - truth @ m)).mean())) for phase in found.phases.T
    ]
    assert abs(round(np.linalg.det(winding))) == 1
    for phase, m in zip(found.phases.T, winding, strict=True):
        assert abs(np.exp(1j * (phase - truth @ m)).mean()) > 0.97


def test_more_angles_than_loops() -> None:
    X, _ = noisy_ring(60, np.random.default_rng(9))
    with pytest.raises(CogmapError, match="only 1 loops to take 9 angles along"):
        circular_coordinates(neighbour_graph(X[:, :2], 4), 9)
