import numpy as np
import pytest
from ripser import ripser
from scipy.sparse.csgraph import shortest_path
from scipy.spatial.distance import cdist
from sklearn.manifold import Isomap

from cogmap.graph.neighbour_graph import SMALLEST, lengthen_shortcuts, neighbour_graph
from cogmap.shape.rips import Given, euclidean, farthest_points, geodesic, geodesics, ratios, rips_bars


@pytest.fixture
def cloud() -> np.ndarray:
    rng = np.random.default_rng(0)
    angle = rng.uniform(0, 2 * np.pi, (2, 120))
    return np.concatenate([np.cos(angle), np.sin(angle), rng.normal(scale=0.1, size=(1, 120))]).T


def test_bars_are_those_of_ripser(cloud: np.ndarray) -> None:
    distances = cdist(cloud, cloud)
    theirs = ripser(distances, maxdim=2, coeff=11, distance_matrix=True)["dgms"]
    for ours, other in zip(rips_bars(distances, [0, 1, 2]), theirs, strict=True):
        order = np.lexsort(ours.T), np.lexsort(other.T)
        # ripser counts in float32
        np.testing.assert_allclose(ours[order[0]], other[order[1]], rtol=1e-5)


def test_bars_come_the_most_outstanding_first(cloud: np.ndarray) -> None:
    for bars in rips_bars(cdist(cloud, cloud), [0, 1, 2]):
        assert (np.diff(ratios(bars)[np.isfinite(bars[:, 1])]) <= 0).all()


def test_upper_triangle_is_not_read(cloud: np.ndarray) -> None:
    distances = cdist(cloud, cloud)
    skewed = np.tril(distances) * (1 + 1e-15) + np.triu(distances)
    lower = np.tril(distances)
    for expected, found in zip(rips_bars(distances, [1, 2]), rips_bars(lower, [1, 2]), strict=True):
        np.testing.assert_array_equal(found, expected)
    for expected, found in zip(rips_bars(distances, [1, 2]), rips_bars(skewed, [1, 2]), strict=True):
        np.testing.assert_allclose(found, expected)


def test_only_pieces_live_for_ever() -> None:
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    distances = np.full((24, 24), np.inf)
    distances[:12, :12] = cdist(ring, ring)
    distances[12:, 12:] = 3 * cdist(ring, ring)
    pieces, loops = rips_bars(distances, [0, 1])
    assert np.isinf(pieces[:, 1]).sum() == 2
    np.testing.assert_allclose(loops, np.outer([1, 3], [2 * np.sin(np.pi / 12), np.sqrt(3)]))


def test_of_more_neighbours_more_must_be_shared() -> None:
    X = np.random.default_rng(3).normal(size=(300, 30))
    found = geodesics(X, (15, 25))
    for space, neighbours in zip(found, (15, 25), strict=True):
        graph, some = neighbour_graph(X, neighbours), np.arange(60)
        with_3, with_5 = (shortest_path(lengthen_shortcuts(graph, shared), indices=some) for shared in (3, 5))
        assert np.mean(with_3 != with_5) > 0.01
        expected = {15: with_3, 25: with_5}[neighbours][:, some]
        np.testing.assert_allclose(space.among(some), expected, rtol=1e-6)


def test_ratio_is_death_over_birth_and_for_pieces_over_the_median() -> None:
    np.testing.assert_array_equal(ratios(np.array([[1.0, 3.0], [2.0, 3.0]])), [3, 1.5])
    np.testing.assert_array_equal(
        ratios(np.array([[0, np.inf], [0, 8], [0, 2.0], [0, 1]])), [np.inf, 4, 1, 0.5]
    )
    assert ratios(np.empty((0, 2))).shape == (0,)


def test_farthest_points_are_the_greedy_ones(cloud: np.ndarray) -> None:
    distances = cdist(cloud, cloud)
    taken = [7]
    for _ in range(29):
        taken.append(int(distances[taken].min(axis=0).argmax()))
    found = farthest_points(euclidean(cloud), 30, start=7)
    np.testing.assert_array_equal(found.indices, taken)
    among = euclidean(cloud).among(found.indices)
    np.testing.assert_allclose(among, distances[np.ix_(taken, taken)], atol=1e-15)
    nearest = distances[:, taken].argmin(axis=1)
    np.testing.assert_array_equal(found.held, np.bincount(nearest, minlength=30))
    fewer = farthest_points(euclidean(cloud), 10, start=7)
    np.testing.assert_array_equal(fewer.indices, found.indices[:10])


def test_farthest_points_stop_when_all_is_covered(cloud: np.ndarray) -> None:
    found = farthest_points(euclidean(np.concatenate([cloud, cloud])), 200, start=0)
    assert len(found.indices) == 120
    np.testing.assert_array_equal(np.sort(found.indices % 120), np.arange(120))


def test_farthest_points_see_every_piece_first() -> None:
    rng = np.random.default_rng(1)
    X = np.concatenate([rng.normal(size=(40, 2)) + 100 * piece for piece in range(5)])
    found = farthest_points(geodesic(X, 15), 20, start=3)
    assert set(found.indices[:5] // 40) == set(range(5))
    assert found.held.sum() == 200


def test_geodesics_are_those_of_isomap() -> None:
    X = np.random.default_rng(2).uniform(size=(150, 2))
    theirs = Isomap(n_neighbors=4).fit(X).dist_matrix_
    seen = geodesic(X, 4)
    np.testing.assert_allclose(seen.among(np.arange(150)), theirs, rtol=1e-6)


def test_landmarks_along_a_graph_are_those_of_its_distances() -> None:
    rng = np.random.default_rng(3)
    seen = geodesic(np.concatenate([rng.uniform(size=(200, 2)), rng.uniform(size=(60, 2)) + 9]), 5)
    ours, theirs = (farthest_points(space, 90, 4) for space in (seen, Given(seen.among(np.arange(260)))))
    np.testing.assert_array_equal(ours.indices, theirs.indices)
    np.testing.assert_array_equal(ours.held, theirs.held)


def test_geodesics_pass_through_repeats() -> None:
    X = np.linspace(0, 1, 30)[:, None]
    seen = geodesic(np.concatenate([X, X]), 2)
    assert seen.lengths(np.array([0]))[0, 30] == SMALLEST
    np.testing.assert_allclose(seen.lengths(np.array([30]), np.array([29, 59])), 1)
