from itertools import pairwise

import networkx as nx
import numpy as np
import pytest
from shapely import LineString, Point, box

from arena import Arena, Disc
from cogmap import CogmapError
from cogmap.evaluation.shortest import shortest_lengths
from cogmap.navigation.place_graph import PlaceGraph

RNG = np.random.default_rng(0)


def around_a_hole(count: int = 4000) -> np.ndarray:
    """Places on a square of 4 but for a square of 2 in its middle."""
    places = RNG.uniform(-2, 2, (count, 2))
    return places[np.abs(places).max(axis=1) > 1]


@pytest.fixture(scope="module")
def ring() -> PlaceGraph:
    return PlaceGraph(around_a_hole())


def length(way: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())


def test_ways_go_around_what_nobody_visited(ring: PlaceGraph) -> None:
    start, goal = np.array([-1.5, 0.1]), np.array([1.5, 0.1])
    way = ring.plan(start, goal)
    np.testing.assert_array_equal(way[[0, -1]], [start, goal])
    assert LineString(way).distance(Point(0, 0)) > 1
    # around two corners, and no farther than the margin asks for
    shortest = 2 * np.hypot(0.5, 0.9) + 2
    assert shortest < length(way) < 1.25 * shortest
    assert not ring.is_free(start, goal)
    assert not ring.sees(start, goal)
    for one, other in pairwise(way):
        assert ring.is_free(one, other)


def test_where_it_is_free_the_way_is_straight(ring: PlaceGraph) -> None:
    way = ring.plan(np.array([-1.5, -1.4]), np.array([1.5, -1.6]))
    assert len(way) == 2
    assert ring.sees(way[0], way[1])


def test_ways_are_little_longer_than_the_shortest_of_a_room() -> None:
    room, body = Arena.load("obstacles"), Disc()
    graph = PlaceGraph(room.sample_free(6000, body.radius, np.random.default_rng(1)))
    ends = room.sample_free(40, body.radius + 0.05, np.random.default_rng(2)).reshape(-1, 2, 2)
    mine = np.array([length(graph.plan(*pair)) for pair in ends])
    ratio = mine / shortest_lengths(room, ends, body.radius)
    assert np.median(ratio) < 1.08
    assert ratio.max() < 1.35


def test_a_margin_is_kept_where_there_is_room(ring: PlaceGraph) -> None:
    shy = PlaceGraph(ring.position, reach=0.15, margin=0.4)
    start, goal = np.array([-1.5, 1.5]), np.array([1.5, -1.5])
    hole = box(-1, -1, 1, 1)
    assert LineString(shy.plan(start, goal)).distance(hole) > 0.3
    assert (
        LineString(PlaceGraph(ring.position, reach=0.15, margin=0.01).plan(start, goal)).distance(hole) < 0.2
    )


def test_ways_are_dijkstras(ring: PlaceGraph) -> None:
    graph = nx.from_scipy_sparse_array(ring._graph)
    cells = ring._nearest_cells(np.array([[-1.5, 0.1], [1.5, 0.1]]))
    trusted = nx.dijkstra_path(graph, *cells)
    middles = ring._middles[trusted]
    # pulling straight leaves corners of that way out, and adds none
    way = ring.plan(middles[0], middles[-1])
    assert length(way) <= length(middles) + 1e-9
    near = np.linalg.norm(way[1:-1, None] - middles[None], axis=2).min(axis=1)
    assert near.max() < 0.5


def test_what_does_not_hang_together_has_no_way() -> None:
    places = RNG.uniform(-1, 1, (3000, 2))
    parted = PlaceGraph(places[np.abs(places[:, 0]) > 0.3])
    with pytest.raises(CogmapError, match="separate parts of what was visited; explore between"):
        parted.plan(np.array([-0.8, 0.0]), np.array([0.8, 0.0]))


def test_bad_positions_are_refused() -> None:
    with pytest.raises(CogmapError, match="one remembered view makes no way"):
        PlaceGraph(np.zeros((1, 2))).plan(np.zeros(2), np.ones(2))
    with pytest.raises(CogmapError, match="position"):
        PlaceGraph(np.full((9, 2), np.nan), reach=1.0).plan(np.zeros(2), np.ones(2))
