"""`make verify`: ten rooms in one map, two that a door joins, a new wall; figures with their bars."""

from collections.abc import Callable

import pytest

from arena import Arena
from cogmap.experiments.registry import run_experiment

pytestmark = pytest.mark.full

REMAPPING = [
    ("heading_over_alone", "≤", 1.2),
    ("position_over_alone", "≤", 1.2),
    ("room_recognised", "≥", 0.99),
    ("between_correlation", "≤", 0.1),
    ("return_correlation", "≥", 0.97),
    ("rooms", "=", 10),
    ("trusted", "=", True),
]
DOOR = [
    ("heading_median_deg", "≤", 2.5),
    ("position_median_m", "≤", 0.05),
    ("position_p95_m", "≤", 0.15),
    ("pieces", "=", 1),
    ("trusted", "=", True),
    *(
        (f"betti/{name}", "=", [1, loops, 0])
        for name, loops in (("view_manifold", 1), ("fused", 1), ("place", 0), ("heading", 1))
    ),
]
RETURNING = [
    ("forgotten_heading_deg", "=", 0.0),
    ("forgotten_position_m", "=", 0.0),
    ("room_recognised", "≥", 0.99),
    ("return_correlation", "≥", 0.97),
]


def test_ten_rooms(judge: Callable[..., None]) -> None:
    judge("remapping", run_experiment("remapping").metrics, REMAPPING)


def test_nothing_of_the_first_room_is_forgotten(judge: Callable[..., None]) -> None:
    judge("returning", run_experiment("returning").metrics, RETURNING)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_door_joins_two_rooms(seed: int, judge: Callable[..., None]) -> None:
    # under another name no third room is learnt beside it
    room = Arena.load("two_rooms").model_copy(update={"name": "joined"})
    judge(f"door {seed}", run_experiment("door", seed=seed, room=room).metrics, DOOR)


@pytest.mark.near_guard  # it passes the bounds, down and up again
def test_a_map_that_follows_a_change_is_not_trusted_before_it_is_right(judge: Callable[..., None]) -> None:
    figures = run_experiment("new_wall", views=9000).metrics
    judge(
        "new_wall", figures, [("rooms", "=", 1), ("trusted_and_wrong", "≤", 0.0), ("surprise_auc", "≥", 0.9)]
    )
