from unittest.mock import patch

import numpy as np
import pytest

from arena import Arena, Box, Wall
from cogmap import CogmapError, SeparatePiecesWarning
from cogmap.evaluation.deviation import path_deviation
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.paper import roadmap as module
from cogmap.experiments.paper.roadmap import _arrives, _plan, _routes_table, _scores, _summary, draw_pairs
from cogmap.navigation import VisualRoadmap

ROOM = Arena.create(
    name="one box",
    platform=[[(-2, -2), (2, -2), (2, 2), (-2, 2)]],
    walls=[Wall(start=(-3, -3), end=(3, -3), material="brick")],
    boxes=[Box(center=(0, 0), size=(1, 1), material="oak")],
)
BELOW = np.array([[-1.5, -1.0, 0], [0, -1, 0], [1.5, -1, 0]])


def test_pairs_are_apart_free_and_those_of_the_seed() -> None:
    room = Arena.load("obstacles")
    pairs = draw_pairs(room, 0.18, 3)
    np.testing.assert_array_equal(pairs, draw_pairs(room, 0.18, 3))
    assert not np.array_equal(pairs, draw_pairs(room, 0.18, 4))
    assert pairs.shape == (200, 2, 3)
    assert room.is_free(pairs[:, :, :2].reshape(-1, 2), 0.18).all()
    assert np.linalg.norm(pairs[:, 0, :2] - pairs[:, 1, :2], axis=1).min() >= 1
    assert np.abs(np.exp(1j * pairs[:, :, 2]).mean()) < 0.15
    assert 3 < np.abs(pairs[:, :, 2]).max() <= np.pi


def test_a_room_without_such_pairs_is_refused() -> None:
    small = ROOM.model_copy(update={"platform": [[(1, 1), (1.8, 1), (1.8, 1.8), (1, 1.8)]]})
    with pytest.raises(CogmapError, match="'one box' has hardly any places 1 m apart"):
        draw_pairs(small, 0.18, 0)


@pytest.mark.parametrize(
    ("end", "off", "there"),
    [
        (0, [0.2, 0.2, 0.6], True),
        (0, [0.25, 0.2, 0], False),
        (-1, [0.25, 0.2, 0], False),
        (-1, [0.2, 0.2, 0.69], True),
        (-1, [0, 0, 0.71], False),
        (0, [0, 0, -0.71], False),
        (0, [0, 0, 2 * np.pi - 0.6], True),
    ],
)
def test_a_plan_arrives_when_both_its_ends_are_near(end: int, off: list[float], there: bool) -> None:  # noqa: FBT001
    path = np.array([[0.0, 0, 3], [0, 0, 3], [5, 5, 0], [1, 1, -3], [1, 1, -3]])
    path[end] += off
    assert _arrives(path) is there


def test_paths_are_scored_by_length_by_deviation_and_by_what_they_touch() -> None:
    through = BELOW * [1, 0, 1]
    grazing, clear = (BELOW * [1, 0, 1] + [0, -0.5 - away, 0] for away in (0.178, 0.18))
    table = _scores(ROOM, [BELOW, through, grazing, clear, None], np.array([2.0, 3, 3, 3, 3]))
    assert table["success"].tolist() == [True, True, True, True, False]
    assert table["touches"].tolist()[:4] == [False, True, True, False]
    np.testing.assert_allclose(table["length_m"], [3, 3, 3, 3, np.nan])
    np.testing.assert_allclose(table["length_ratio"], [1.5, 1, 1, 1, np.nan])
    np.testing.assert_allclose(table["deviation_mean"], [0, 0, 0, 0, np.nan], atol=1e-12)
    bent = np.array([[-1.5, -1.0, 0], [0, -1.9, 2], [1.5, -1, 0]])
    names = ["deviation_mean", "deviation_variance", "deviation_maximum"]
    np.testing.assert_allclose(_scores(ROOM, [bent], np.ones(1))[names].to_numpy()[0], path_deviation(bent))


def test_the_summary_counts_failures_as_failures_only() -> None:
    bent = BELOW + np.array([[0, 0, 0], [0, 1, 0], [0, 0, 0]])
    scores = _scores(ROOM, [BELOW, bent, None, None], np.full(4, 3.0))
    found = _summary(scores)
    assert found["success"] == 0.5
    assert found["paths_touching"] == 0.5
    assert found["length_ratio_median"] == pytest.approx((1 + 2 * np.hypot(1.5, 1) / 3) / 2)
    deviation = path_deviation(bent)
    assert found["deviation_mean"] == pytest.approx(deviation.mean / 2)
    assert found["deviation_variance"] == pytest.approx(deviation.variance / 2)
    assert found["deviation_max"] == pytest.approx(deviation.maximum / 2)


def test_plans_lead_from_start_through_views_to_goal_and_fail_where_there_is_no_way() -> None:
    x = np.append(np.arange(0, 3, 0.1), np.arange(9, 10, 0.1))
    poses = np.column_stack([x, np.zeros((len(x), 2))])
    planner = VisualRoadmap(x[:, None], neighbours=2)
    pairs = np.array(
        [[[0.2, 0.1, 0], [0.5, -0.1, 0.3]], [[0.2, 0, 0], [9.5, 0, 0]], [[0.2, 0, 0], [5, 0, 0]]]
    )
    with pytest.warns(SeparatePiecesWarning, match="no way leads from one to another"):
        found = _plan(planner, pairs[:, :, :1], pairs, poses)
    assert found[0].route.tolist() == [2, 3, 4, 5]
    np.testing.assert_array_equal(found[0].path, [pairs[0, 0], *poses[2:6], pairs[0, 1]])
    assert len(found[1].route) == 0
    assert found[1].path is None
    assert found[2].route[-1] == 29
    assert found[2].path is None
    assert all(0 < plan.milliseconds < 1000 for plan in found)
    table = _routes_table([plan.route for plan in found], poses)
    assert table["pair"].tolist() == 4 * [0] + len(found[2].route) * [2]
    np.testing.assert_array_equal(table[["x_m", "y_m", "heading_rad"]], poses[table["view"]])


def test_without_a_peer_few_views_lead_almost_everywhere_and_on_short_ways() -> None:
    with patch.object(module, "prm_paths", return_value=None):
        found = module.roadmap(Conditions(Arena.load("obstacles"), 2500, seed=0))
    assert not found.metrics["prm"]
    assert not [key for key in found.metrics if key.startswith("prm_") or key == "deviation_ratio"]
    assert found.metrics["success"] > 0.8
    assert found.metrics["length_ratio_median"] < 1.5
    assert found.metrics["deviation_mean"] < 0.6
    assert found.tables["routes"]["pair"].nunique() >= 200 * found.metrics["success"]
    assert len(found.figures["routes"].axes) == module.SHOWN
