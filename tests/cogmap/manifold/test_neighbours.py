import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

from cogmap.errors import CogmapError
from cogmap.manifold.neighbours import DETOUR, TINY, components, lengthen_shortcuts, neighbour_graph


@given(st.integers(0, 1000), st.integers(1, 8), st.integers(1, 20))
@settings(deadline=None, max_examples=20)
def test_graph_joins_whoever_is_nearest_of_either(seed: int, neighbours: int, features: int) -> None:
    X = np.random.default_rng(seed).normal(size=(40, features))
    apart = cdist(X, X)
    np.fill_diagonal(apart, np.inf)
    nearest = apart <= np.sort(apart, axis=1)[:, neighbours - 1 : neighbours]
    graph = neighbour_graph(X, neighbours).toarray()
    np.testing.assert_allclose(graph, np.where(nearest | nearest.T, apart, 0), rtol=1e-6)


def test_graph_is_exactly_symmetric() -> None:
    X = np.random.default_rng(0).normal(size=(500, 60)).astype(np.float32)
    graph = neighbour_graph(X)
    assert (graph != graph.T).nnz == 0
    assert graph.dtype == np.float64
    assert (graph.data > 0).all()


def test_pieces_stay_pieces() -> None:
    rng = np.random.default_rng(1)
    X = np.concatenate([rng.normal(size=(60, 2)) + shift for shift in ([0, 0], [50, 0], [0, 50])])
    number, labels = components(neighbour_graph(X))
    assert number == 3
    np.testing.assert_array_equal(labels, np.repeat([0, 1, 2], 60))


def test_repeated_points_stay_connected() -> None:
    rng = np.random.default_rng(2)
    X = rng.normal(size=(50, 3))
    repeated = np.concatenate([X, np.repeat(X[:1], 40, axis=0), X[5:8]])
    graph = neighbour_graph(repeated)
    assert components(graph).number == 1
    assert graph[60, 0] == TINY
    assert graph[91, 6] == TINY
    np.testing.assert_array_equal(graph[:50, :50].toarray(), neighbour_graph(X).toarray())


def test_points_nearer_than_rounding_stay_connected() -> None:
    X = np.random.default_rng(3).normal(size=(40, 30)).astype(np.float32) + 1000
    X = np.concatenate([X, np.nextafter(X, np.float32(np.inf))])
    assert components(neighbour_graph(X, 1)).number <= 40


def test_shortcuts_become_long() -> None:
    rng = np.random.default_rng(4)
    X = rng.uniform(size=(800, 2))
    graph = neighbour_graph(X)
    far = [(a, b) for a, b in rng.integers(800, size=(40, 2)) if np.hypot(*(X[a] - X[b])) > 0.5]
    rows, columns = np.array(far).T
    jumps = sp.csr_array((np.full(len(far), 0.1), (rows, columns)), shape=graph.shape)
    longer = lengthen_shortcuts(sp.csr_array(graph + jumps + jumps.T))
    np.testing.assert_allclose(longer[rows, columns], 0.1 * DETOUR)
    same = (longer.multiply(graph.astype(bool)) != graph).nnz
    assert same < 0.02 * graph.nnz
    assert (longer != longer.T).nnz == 0
    assert (lengthen_shortcuts(graph, 0) != graph).nnz == 0


def test_common_neighbours_are_counted_right() -> None:
    graph = neighbour_graph(np.random.default_rng(5).normal(size=(60, 2)), 5)
    joined = graph.toarray() > 0
    for shared in range(6):
        few = (joined.astype(int) @ joined) < shared
        expected = np.where(few, DETOUR, 1) * graph.toarray()
        np.testing.assert_array_equal(lengthen_shortcuts(graph, shared).toarray(), expected)


@pytest.mark.parametrize("neighbours", [3, 5, 10, 15])
def test_a_curve_has_no_shortcuts(neighbours: int) -> None:
    angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    graph = neighbour_graph(np.stack([np.cos(angle), np.sin(angle)], axis=1), neighbours)
    assert (lengthen_shortcuts(graph, neighbours // 5) != graph).nnz == 0


@pytest.mark.parametrize(
    ("X", "neighbours", "message"),
    [
        (np.zeros(20), 15, r"shape \(20,\)"),
        (np.zeros((20, 0)), 15, r"shape \(20, 0\)"),
        (np.full((20, 2), np.nan), 15, "NaN"),
        (np.full((20, 2), np.inf, dtype=np.float32), 15, "NaN"),
        (np.eye(15), 15, "15 distinct points cannot have 15"),
        (np.zeros((100, 3)), 15, "1 distinct points"),
        (np.eye(20), 0, "at least one"),
    ],
)
def test_bad_input_gets_one_sentence(X: np.ndarray, neighbours: int, message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        neighbour_graph(X, neighbours)
