from itertools import pairwise

import networkx as nx
import numpy as np
import pandas as pd
import pytest
import scipy.sparse as sp
import shapely
import torch

from cogmap.errors import CogmapError, SeparatePiecesWarning
from cogmap.graph.neighbour_graph import neighbour_graph
from cogmap.navigation.roadmap import VisualRoadmap


def test_it_plans_what_networkx_plans() -> None:
    rng = np.random.default_rng(0)
    points = rng.random((200, 3))
    planner = VisualRoadmap(points, neighbours=8, power=1.5, one_sided=3)
    graph = neighbour_graph(points, 8, one_sided=3)
    graph.data **= 1.5
    theirs = nx.from_scipy_sparse_array(graph)
    for start, goal in rng.integers(0, 200, (20, 2)):
        route = planner.plan(points[start], points[goal])
        assert route[0] == start
        assert route[-1] == goal
        cost = sum(graph[a, b] for a, b in pairwise(route))
        assert cost == pytest.approx(nx.dijkstra_path_length(theirs, start, goal))


def test_views_are_joined_to_their_five_nearest_unless_told() -> None:
    points = np.random.default_rng(1).random((60, 2))
    wanted = neighbour_graph(points, 8, one_sided=5)
    assert (VisualRoadmap(points, neighbours=8, power=1.0).graph != wanted).nnz == 0


def test_views_that_never_enter_obstacles_lead_around_them() -> None:
    """Features are a curved image of (x, y) around two boxes, told apart by nothing but the gap in them."""
    rng = np.random.default_rng(0)
    boxes = shapely.MultiPolygon([shapely.box(-1.2, -0.5, -0.4, 1.6), shapely.box(0.4, -1.6, 1.2, 0.5)])
    places = rng.uniform([-2, -1.6], [2, 1.6], (4000, 2))
    places = places[~shapely.contains_xy(boxes.buffer(0.1), *places.T)]
    x, y = places.T
    curved = np.column_stack([x, 0.5 * np.sin(2 * x) + y, 0.5 * np.cos(2 * y), 0.4 * np.sin(x + y)])
    planner = VisualRoadmap(curved, neighbours=15)
    # From left to right one must pass below the first box and above the second.
    corners = np.array([[-1.2, -0.6], [-0.3, -0.6], [0.3, 0.6], [1.3, 0.6]])
    for start, goal in (([-1.9, 1.2], [1.9, -1.2]), ([1.8, 0.0], [-1.8, 0.2])):
        ends = [int(np.argmin(np.linalg.norm(places - end, axis=1))) for end in (start, goal)]
        route = planner.plan(*curved[ends])
        way = shapely.LineString(places[route])
        assert [route[0], route[-1]] == ends
        assert not way.intersects(boxes)
        around = corners if start[0] < 0 else corners[::-1]
        least = shapely.LineString([places[route[0]], *around, places[route[-1]]]).length
        assert way.length < 1.25 * least


def test_start_and_goal_are_taken_for_the_nearest_views() -> None:
    line = np.arange(20.0)[:, None]
    route = VisualRoadmap(line, neighbours=2).plan(np.array([2.2]), np.array([[6.9]]))
    assert route.tolist() == [2, 3, 4, 5, 6, 7]


def test_words_are_compared_by_direction() -> None:
    seen = np.maximum(0, 2 - np.abs(np.arange(15)[:, None] - np.arange(15)))
    words = sp.csr_array(seen.astype(np.float32))
    planner = VisualRoadmap(words, neighbours=2, metric="cosine")
    route = planner.plan(sp.csr_array(5 * words[[1]]), words[[13]])
    assert route[0] == 1
    assert route[-1] == 13
    assert (np.abs(np.diff(route)) <= 2).all()


def test_words_of_any_number_lead_by_direction_and_not_by_nearness() -> None:
    angles = np.linspace(0, 1.5, 16)
    views = np.column_stack([np.cos(angles), np.sin(angles)]) * np.array([1.0, 9.0] * 8)[:, None]
    planner = VisualRoadmap(views, neighbours=2, metric="cosine")
    assert planner.nearest(8 * views[0]) == 0
    assert planner.nearest(views[7] / 90) == 7
    assert planner.plan(20 * views[2], views[13] / 20)[[0, -1]].tolist() == [2, 13]


def test_equal_views_stay_joined() -> None:
    points = np.repeat(np.arange(10.0), 3)[:, None]
    route = VisualRoadmap(points, neighbours=2, power=2.0).plan(points[0], points[-1])
    assert points[route[0], 0] == 0
    assert points[route[-1], 0] == 9


def test_one_view_is_the_whole_way() -> None:
    planner = VisualRoadmap(np.array([[1.0, 2.0]]))
    assert planner.plan(np.array([0.0, 0.0]), np.array([5.0, 5.0])).tolist() == [0]


def test_no_way_leads_between_separate_pieces() -> None:
    points = np.concatenate([np.arange(10.0), 100 + np.arange(5.0)])[:, None]
    planner = VisualRoadmap(points, neighbours=2)
    refused = pytest.raises(CogmapError, match="separate pieces of the neighbour graph, of 10 and 5 views")
    with refused, pytest.warns(SeparatePiecesWarning, match=r"2 pieces \(of 10, 5 points\)"):
        planner.plan(points[0], points[-1])
    assert planner.plan(points[10], points[14])[-1] == 14


def test_features_may_be_lists_frames_and_tensors() -> None:
    points = np.random.default_rng(0).random((60, 3))
    way = VisualRoadmap(points).plan(points[0], points[9]).tolist()
    for features, view in (
        (points.tolist(), points[0].tolist()),
        (torch.from_numpy(points), torch.from_numpy(points[0])),
        (pd.DataFrame(points), pd.Series(points[0])),
        (sp.csr_matrix(points), sp.csr_matrix(points[:1])),
    ):
        assert VisualRoadmap(features).plan(view, points[9:10]).tolist() == way


def test_features_that_do_not_fit_are_refused() -> None:
    planner = VisualRoadmap(np.eye(5), neighbours=2)
    with pytest.raises(CogmapError, match="give one row of 5 features"):
        planner.plan(np.ones(4), np.ones(5))
    with pytest.raises(CogmapError, match="give one row of 5 features"):
        planner.plan(np.ones((2, 5)), np.ones(5))
    with pytest.raises(CogmapError, match="NaN"):
        planner.plan(np.full(5, np.nan), np.ones(5))
