import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.csgraph import dijkstra

from cogmap.graph import shortest_paths
from cogmap.graph.neighbour_graph import SMALLEST, neighbour_graph
from cogmap.graph.shortest_paths import Paths


def clouds() -> dict[str, sp.csr_array]:
    """Graphs of many kinds: in pieces, with repeats, with lengths of all sizes, one way, without edges."""
    rng = np.random.default_rng(0)
    X = rng.normal(size=(300, 3))
    cloud = neighbour_graph(X, 6)
    wild = cloud.copy()
    wild.data = 10.0 ** rng.uniform(-12, 12, wild.nnz)
    line = sp.diags_array([rng.uniform(size=299)], offsets=[1], shape=(300, 300), format="csr")
    return {
        "cloud": cloud,
        "single": cloud.astype(np.float32),
        "pieces": neighbour_graph(np.concatenate([X, X + 99]), 6),
        "repeats": neighbour_graph(np.repeat(X, 40, axis=0), 6),
        "all sizes": wild,
        "one way": sp.csr_array(line),
        "empty": sp.csr_array((5, 5)),
    }


@pytest.mark.parametrize(
    ("window", "task"), [(0.0, 1), (1e-9, 1), (shortest_paths.WINDOW, 1), (1e9, shortest_paths.TASK)]
)
@pytest.mark.parametrize("name", clouds())
def test_lengths_are_those_of_dijkstra_to_the_bit(
    name: str, window: float, task: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shortest_paths, "WINDOW", window)
    monkeypatch.setattr(shortest_paths, "TASK", task)
    graph = clouds()[name]
    points = graph.shape[0]
    sources = np.arange(0, points, max(1, points // 20))
    theirs = dijkstra(graph, indices=sources)
    paths = Paths(graph)
    assert len(paths) == points
    np.testing.assert_array_equal(paths.lengths(sources), theirs)
    np.testing.assert_array_equal(paths.lengths(sources, sources[::-2]), theirs[:, sources[::-2]])
    np.testing.assert_array_equal(paths.among(sources), theirs[:, sources])


@pytest.mark.parametrize("name", clouds())
def test_the_nearer_of_several_points_is_the_least_of_their_lengths(name: str) -> None:
    graph = clouds()[name]
    paths, nearest = Paths(graph), np.full(graph.shape[0], np.inf)
    for point in (0, graph.shape[0] - 1, graph.shape[0] // 2, 0):
        before = nearest.copy()
        nearer = paths.nearer(point, nearest)
        np.testing.assert_array_equal(nearest, before)
        nearest = nearer
        np.testing.assert_array_equal(nearest, np.minimum(before, dijkstra(graph, indices=[point])[0]))


def test_an_edge_between_equals_is_an_edge() -> None:
    graph = sp.csr_array(np.array([[0, SMALLEST, 0], [SMALLEST, 0, 1], [0, 1, 0]]))
    np.testing.assert_array_equal(Paths(graph).lengths(np.array([0, 2])), [[0, SMALLEST, 1], [1, 1, 0]])
