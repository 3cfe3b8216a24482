import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

from cogmap.errors import CogmapError
from cogmap.graph.neighbour_graph import (
    SMALLEST,
    checked_graph,
    components,
    lengthen_shortcuts,
    neighbour_graph,
    neighbourhood_means,
)


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
    assert graph[60, 0] == SMALLEST
    assert graph[91, 6] == SMALLEST
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
    np.testing.assert_allclose(longer[rows, columns], 0.5)
    same = (longer.multiply(graph.astype(bool)) != graph).nnz
    assert same < 0.02 * graph.nnz
    assert (longer != longer.T).nnz == 0
    assert (lengthen_shortcuts(graph, 0) != graph).nnz == 0
    assert (lengthen_shortcuts(graph, detour=1.0) != graph).nnz == 0


def test_common_neighbours_are_counted_right() -> None:
    graph = neighbour_graph(np.random.default_rng(5).normal(size=(60, 2)), 5)
    joined = graph.toarray() > 0
    for shared in range(6):
        few = (joined.astype(int) @ joined) < shared
        expected = np.where(few, 5, 1) * graph.toarray()
        np.testing.assert_array_equal(lengthen_shortcuts(graph, shared).toarray(), expected)


@pytest.mark.parametrize("neighbours", [3, 5, 10, 15])
def test_a_curve_has_no_shortcuts(neighbours: int) -> None:
    angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    graph = neighbour_graph(np.stack([np.cos(angle), np.sin(angle)], axis=1), neighbours)
    assert (lengthen_shortcuts(graph, neighbours // 5) != graph).nnz == 0


def bags(views: int, rng: np.random.Generator) -> sp.csr_array:
    return sp.csr_array((rng.uniform(size=(views, 50)) < 0.3) * rng.uniform(0.5, 2, 50))


def test_graph_of_words_joins_by_chords() -> None:
    X = bags(60, np.random.default_rng(6))
    unit = X.toarray() / np.linalg.norm(X.toarray(), axis=1, keepdims=True)
    expected = neighbour_graph(unit, 5)
    np.testing.assert_allclose(
        neighbour_graph(X, 5, metric="cosine").toarray(), expected.toarray(), atol=1e-7
    )
    np.testing.assert_allclose(
        neighbour_graph(sp.csr_array(unit), 5).toarray(), expected.toarray(), atol=1e-7
    )


def test_views_that_share_no_word_are_not_joined() -> None:
    rng = np.random.default_rng(7)
    X = np.zeros((90, 110))
    X[:40, :50], X[40:80, 50:100] = bags(40, rng).toarray(), bags(40, rng).toarray()
    X[80:85, 100:] = rng.uniform(0.1, 1, size=(5, 10))
    graph = neighbour_graph(sp.csr_array(X), 8, metric="cosine")
    found = components(graph)
    np.testing.assert_array_equal(np.sort(found.sizes), [5, 5, 40, 40])
    # Fewer than eight others to be near to, and views without words, which repeat each other.
    np.testing.assert_array_equal((graph[80:85] > 0).sum(axis=1), 4)
    np.testing.assert_array_equal(
        graph[85:, 85].toarray().ravel(), [0, SMALLEST, SMALLEST, SMALLEST, SMALLEST]
    )


def test_constant_views_are_one_point_too_few() -> None:
    with pytest.raises(CogmapError, match="1 distinct points"):
        neighbour_graph(sp.csr_array(np.ones((30, 4))), 3, metric="cosine")


def test_components_are_reported_largest_first() -> None:
    edges = sp.coo_array((np.ones(5), ([1, 2, 4, 5, 8], [2, 3, 5, 6, 9])), shape=(10, 10))
    number, labels = found = components(sp.csr_array(edges + edges.T))
    assert number == 5
    np.testing.assert_array_equal(found.sizes, [3, 3, 2, 1, 1])
    np.testing.assert_array_equal(labels, [3, 0, 0, 0, 1, 1, 1, 4, 2, 2])


def test_means_are_over_a_point_and_its_neighbours() -> None:
    graph = neighbour_graph(np.random.default_rng(8).normal(size=(40, 2)), 4)
    near = (graph.toarray() > 0) | np.eye(40, dtype=bool)
    np.testing.assert_allclose(neighbourhood_means(graph).toarray(), near / near.sum(axis=1, keepdims=True))


@pytest.mark.parametrize(
    ("graph", "message"),
    [
        (np.ones((3, 4)), r"shape \(3, 4\)"),
        (np.array([[0, -1], [-1, 0]]), "not positive"),
        (np.array([[0, np.nan], [np.nan, 0]]), "not positive and finite"),
        (np.array([[0, 1, 0], [2, 0, 0], [0, 0, 0]]), "not symmetric"),
    ],
)
def test_bad_graph_gets_one_sentence(graph: np.ndarray, message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        checked_graph(sp.csr_array(graph))


def test_stored_zeros_are_no_edges() -> None:
    stored = sp.csr_array((np.array([1.0, 0.0, 1.0, 0.0]), ([0, 0, 1, 2], [1, 2, 0, 0])), shape=(3, 3))
    assert checked_graph(stored).nnz == 2
    assert stored.nnz == 4


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


def test_one_sided_edges_are_left_out_but_for_the_nearest() -> None:
    # A crowd, and a loner whose neighbours are all in the crowd and have nearer ones.
    crowd = np.random.default_rng(0).normal(size=(60, 2))
    points = np.vstack([crowd, [[9.0, 0.0]]])
    whole, mutual, some = (neighbour_graph(points, 6, one_sided=count) for count in (None, 0, 2))
    assert (whole[[60]] > 0).sum() == 6
    assert (mutual[[60]] > 0).sum() == 0
    nearest = np.argsort(np.linalg.norm(crowd - points[60], axis=1))[:2]
    assert set(np.flatnonzero(some[[60]].toarray())) == set(nearest)
    distance = np.linalg.norm(points[:, None] - points, axis=2)
    rank = np.argsort(np.argsort(distance, axis=1), axis=1)
    expected = (rank <= 6) & (rank.T <= 6) & ~np.eye(61, dtype=bool)
    np.testing.assert_array_equal(mutual.toarray() > 0, expected)


def test_lengths_there_and_back_may_differ_by_rounding() -> None:
    graph = neighbour_graph(np.random.default_rng(0).random((40, 2)), 5)
    rounded = sp.csr_array(sp.triu(graph) + sp.tril(graph).astype(np.float32).astype(float))
    assert abs(rounded - rounded.T).nnz
    mended = checked_graph(rounded)
    assert not abs(mended - mended.T).nnz
    np.testing.assert_allclose(mended.toarray(), graph.toarray(), rtol=1e-6)
    np.testing.assert_array_equal(checked_graph(graph.toarray().tolist()).toarray(), graph.toarray())
    with pytest.raises(CogmapError, match="there and back differ by up to"):
        checked_graph(sp.csr_array(sp.triu(graph) * 1.01 + sp.tril(graph)))
