import numpy as np
import pytest

from cogmap import CogmapError
from cogmap.navigation.place_graph import PlaceGraph


@pytest.fixture(scope="module")
def ring() -> np.ndarray:
    """Places of a square of side 4 around a round hole of radius 1."""
    places = np.random.default_rng(0).uniform(-2, 2, (9000, 2))
    return places[np.hypot(*places.T) > 1]


def _length(way: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())


def test_a_way_goes_round_what_was_never_visited(ring: np.ndarray) -> None:
    graph = PlaceGraph(ring)
    start, goal = np.array([-1.5, 0.05]), np.array([1.5, 0.05])
    way = graph.plan(start, goal)
    np.testing.assert_array_equal(way[[0, -1]], [start, goal])
    points = np.concatenate(
        [a + np.linspace(0, 1, 50)[:, None] * (b - a) for a, b in zip(way[:-1], way[1:], strict=True)]
    )
    assert np.hypot(*points.T).min() > 1
    # two tangents and the arc between them
    reach = 1.5
    shortest = 2 * np.sqrt(reach**2 - 1) + (np.pi - 2 * np.arccos(1 / reach))
    assert shortest < _length(way) < 1.1 * shortest
    assert not graph.is_free(start, goal)


def test_a_free_way_is_straight_and_a_margin_is_kept(ring: np.ndarray) -> None:
    graph = PlaceGraph(ring, margin=0.3)
    assert len(graph.plan(np.array([-1.5, -1.6]), np.array([1.5, -1.5]))) == 2
    way = graph.plan(np.array([-1.5, 0.0]), np.array([1.5, 0.1]))
    assert np.hypot(*way[1:-1].T).min() > 1.2


def test_separate_parts_have_no_way(ring: np.ndarray) -> None:
    apart = np.concatenate([ring, ring + [9.0, 0.0]])
    with pytest.raises(CogmapError, match="separate parts"):
        PlaceGraph(apart).plan(np.array([-1.5, 0.0]), np.array([9.0, 1.5]))
    with pytest.raises(CogmapError, match="one remembered view"):
        PlaceGraph(np.zeros((1, 2))).plan(np.zeros(2), np.ones(2))
