from collections.abc import Callable

import numpy as np
import pytest

from arena import Arena, Camera
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.registry import run_experiment
from cogmap.experiments.rooms import remapping
from cogmap.experiments.rooms.many_rooms import HOUSE, room_of_house
from cogmap.experiments.rooms.remapping import changed_rooms
from cogmap.experiments.trial import Trial


def test_the_house_has_ten_rooms_of_one_size_that_look_otherwise() -> None:
    rooms = [Arena.load(HOUSE[0]), *map(room_of_house, HOUSE[1:])]
    assert len({room.name for room in rooms}) == 10
    assert {tuple(wall.start for wall in room.walls) for room in rooms} == {
        tuple(wall.start for wall in rooms[0].walls)
    }
    assert all(room.walkable.equals(rooms[0].walkable) for room in rooms)
    eye, pose = Camera.panoramic(90, 15), np.array([[0.3, 0.2, 1.0]])
    views = [eye.render(room, pose).astype(int) for room in rooms]
    apart = [np.abs(one - other).mean() for i, one in enumerate(views) for other in views[:i]]
    assert min(apart) > 5  # grey levels; 20 cm aside in one room makes 3.6
    shared = [tuple(sorted(str(wall.material) for wall in room.walls)) for room in rooms]
    assert len({material for walls in shared for material in walls}) < 4 * len(rooms)


def test_one_thing_changes_at_a_time() -> None:
    room = Arena.load("furnished")
    changed = changed_rooms(room)
    assert changed["nothing"] == room
    for name, other in changed.items():
        differs = {
            key for key in ("walls", "boxes", "sources", "light") if getattr(room, key) != getattr(other, key)
        }
        wanted = {
            "nothing": set(),
            "one box gone": {"boxes"},
            "all boxes white": {"boxes"},
            "one wall": {"walls"},
            "all walls": {"walls"},
            "light from one side": {"light"},
            "smells": {"sources"},
            "walls and smells": {"walls", "sources"},
        }
        assert differs == wanted[name], name
    one = zip(room.walls, changed["one wall"].walls, strict=True)
    assert sum(before != after for before, after in one) == 1


@pytest.mark.near_guard  # cells remap whether maps are trusted or not
def test_rooms_are_told_apart_and_cells_remap(
    monkeypatch: pytest.MonkeyPatch, two_rooms_of_house: Callable[[Conditions], list[Trial]], eye: Camera
) -> None:
    monkeypatch.setattr(remapping, "HOUSE", HOUSE[:2])
    monkeypatch.setattr(
        remapping,
        "changed_rooms",
        lambda room: {key: changed_rooms(room)[key] for key in ("nothing", "walls and smells")},
    )
    monkeypatch.setattr(remapping, "house_of", two_rooms_of_house)
    found = run_experiment("remapping", views=900, camera=eye, map={"place_cells": 40})
    metrics = found.metrics
    assert metrics["rooms"] == 2
    assert metrics["room_recognised"] > 0.9
    assert metrics["between_correlation"] < 0.3
    assert metrics["return_correlation"] > 0.9
    assert metrics["remapping_index"] > 0.7
    assert 0 < metrics["active_in_both"] <= metrics["active_share"] <= 1
    assert metrics["changes"] == {"nothing": "none", "walls and smells": "global"}
    assert list(found.tables["rooms"]["room"]) == list(HOUSE[:2])
    assert len(found.tables["pairs"]) == 1
    # of 900 views hardly a map of a room alone is trusted, and a room without one is not passed over
    rooms = found.tables["rooms"]
    assert rooms["heading_alone_deg"].isna().any()
    assert np.isnan(metrics["heading_over_alone"])
    assert np.isnan(metrics["position_over_alone"])
