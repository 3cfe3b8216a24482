import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from cogmap.graph.spots import spot_graph, spots


def stays(rng: np.random.Generator) -> np.ndarray:
    """Places in a square; at the first the body stayed for long."""
    places = rng.uniform(-1, 1, (200, 2))
    return np.concatenate([places, places[:1] + 1e-4 * rng.standard_normal((150, 2))])


def test_points_at_one_spot_count_once() -> None:
    found = spots(stays(np.random.default_rng(0)))
    at_first = np.flatnonzero(found.first >= 200)
    assert len(at_first) == 0
    assert len(found.first) > 190
    assert (np.linalg.norm(np.diff(stays(np.random.default_rng(0))[found.first], axis=0), axis=1) > 0).all()


def test_each_point_belongs_to_the_nearest_spot() -> None:
    points = stays(np.random.default_rng(1))
    found = spots(points)
    apart = np.linalg.norm(points[:, None] - points[found.first], axis=2)
    assert np.array_equal(apart[np.arange(350), found.of], apart.min(axis=1))
    assert np.array_equal(found.of[found.first], np.arange(len(found.first)))


def test_a_spot_is_joined_to_others_however_long_the_stay() -> None:
    points = stays(np.random.default_rng(2))
    graph = spot_graph(points, 8)
    assert abs(graph - graph.T).max() == 0
    assert connected_components(graph)[0] == 1
    elsewhere = sp.csr_array(graph[[0], 1:200])
    assert elsewhere.nnz >= 8
    rows, columns = graph.nonzero()
    np.testing.assert_allclose(graph.data, np.linalg.norm(points[rows] - points[columns], axis=1), atol=1e-12)


def test_few_points_have_fewer_neighbours() -> None:
    assert spot_graph(np.arange(3.0)[:, None], 8).nnz == 6
