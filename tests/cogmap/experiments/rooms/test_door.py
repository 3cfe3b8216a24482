import pytest
import shapely

from arena import Camera
from cogmap.experiments.registry import run_experiment
from cogmap.experiments.rooms.many_rooms import room_of_house


def test_three_rooms_hang_together_by_two_doors() -> None:
    room = room_of_house("three_rooms")
    free = room.free_space(0.18)
    assert free.geom_type == "Polygon"
    for door in ((-2.0, 0.0), (2.0, 0.0)):
        assert free.contains(shapely.Point(door))
    assert not free.contains(shapely.Point(-2.0, 1.0))


def test_both_are_learnt_as_one_piece() -> None:
    found = run_experiment("door", views=600, camera=Camera.panoramic(90, 15), map={"place_cells": 40})
    found = found.metrics
    for prefix in ("", "third_room_"):
        assert found[f"{prefix}pieces"] == 1
        assert found[f"{prefix}position_median_m"] < 2.0
        assert found[f"{prefix}betti"]["view_manifold"][0] == 1
    assert found["third_room_views"] == pytest.approx(600 * 29 / 19, abs=1)
