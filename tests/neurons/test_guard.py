import math
from typing import Any

import pytest

from neurons.guard import Agreement, Guard

SOUND = Agreement(
    signs=1.0,
    phases=0.9999,
    connected=False,
    foretold=0.97,
    ambiguous=0.0,
    aliased=0.0,
    views_per_chart=5.7,
    dimension=3,
    vote=0.8,
    felt=0.05,
)


def told(**figures: Any) -> Agreement:
    return SOUND._replace(**figures)


@pytest.mark.parametrize(
    ("signs", "phases", "bounds", "said"),
    [
        (1.0, 0.9, {}, "too coarse"),
        (0.9, 0.9999, {}, "heading axes"),
        (math.nan, math.nan, {}, "no loop"),
        (1.0, 0.9999, {}, ""),
        (1.0, 0.9, {"least_eigenvalue": 0.85}, ""),
        (1.0, 0.9999, {"least_eigenvalue": 0.99995}, "below 0.99995"),
        (0.9, 0.9999, {"least_sign_agreement": 0.85}, ""),
        (0.996, 0.9999, {"least_sign_agreement": 0.997}, "heading axes"),
    ],
)
def test_atlas(signs: float, phases: float, bounds: dict[str, float], said: str) -> None:
    reason = Guard(**bounds).atlas(signs, phases)
    assert said in reason
    assert bool(reason) == bool(said)


@pytest.mark.parametrize(
    ("figures", "said"),
    [
        ({}, ""),
        # no walk, no evidence: charts that agree will do
        ({"foretold": math.nan}, ""),
        ({"foretold": 0.79}, "does not confirm its headings"),
        ({"foretold": 0.81}, ""),
        ({"foretold": 0.5, "ambiguous": 0.1}, ""),
        ({"foretold": -0.1}, "anywhere but ahead"),
        ({"ambiguous": 0.3}, "30% of its charts smell and head"),
        ({"ambiguous": 0.2}, ""),
        ({"aliased": 0.02}, "2.0% of its charts look like"),
        ({"aliased": 0.01}, ""),
        ({"phases": 0.998}, ""),
        ({"phases": 0.998, "foretold": 0.89}, "agree only to 0.9980"),
        ({"phases": 0.998, "foretold": math.nan}, "agree only to 0.9980"),
        ({"phases": 0.997}, "agree only to 0.9970"),
        ({"signs": 0.98}, ""),
        ({"signs": 0.96}, "heading axes"),
        ({"phases": 0.998, "signs": 0.96}, "agree only"),
        ({"connected": True}, ""),
        ({"connected": True, "foretold": 0.85}, "foretells 0.85 of the other"),
        ({"connected": True, "foretold": math.nan}, "walking does not confirm"),
        ({"phases": math.nan, "signs": math.nan}, "no loop"),
        ({"felt": 0.35}, "of 3 directions smell should leave one alone, that of turning"),
        ({"felt": 0.3}, ""),
        ({"felt": math.nan, "vote": math.nan}, ""),
        ({"vote": 0.35, "dimension": 4}, "only 35% of its charts tell 4 degrees of freedom"),
        ({"vote": 0.45}, ""),
        ({"vote": 0.35, "phases": 0.9}, "agree only"),
    ],
)
def test_heading(figures: dict[str, Any], said: str) -> None:
    reason = Guard().heading(told(**figures))
    assert said in reason
    assert bool(reason) == bool(said)


def test_place_needs_heading_and_smells_that_mean_one_place() -> None:
    guard = Guard()
    assert guard.place(SOUND) == ""
    assert guard.place(told(ambiguous=0.02)) == ""
    assert "several places; use more odour sources" in guard.place(told(ambiguous=0.1))
    assert guard.heading(told(phases=0.9)) in guard.place(told(phases=0.9))


def test_positions_need_poses_that_are_not_taken_for_others() -> None:
    guard = Guard()
    assert guard.poses(told(phases=0.9, signs=0.9)) == ""
    assert guard.poses(told(foretold=0.5)) == ""
    for figures in ({"foretold": -1.0}, {"ambiguous": 0.4}, {"aliased": 0.1}):
        assert guard.poses(told(**figures)) == guard.heading(told(**figures)) != ""


@pytest.mark.parametrize("figures", [{"foretold": -1.0}, {"ambiguous": 0.4}, {"aliased": 0.1}])
def test_advice_is_charts_only_where_they_are_few(figures: dict[str, Any]) -> None:
    guard = Guard()
    assert "landmark" in guard.poses(told(**figures))
    assert "charts; " not in guard.poses(told(**figures))
    coarse = guard.poses(told(**figures, views_per_chart=34.0))
    assert coarse.endswith("; use more charts")
