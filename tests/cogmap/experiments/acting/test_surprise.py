import numpy as np
import pytest
import shapely

from arena import Arena
from cogmap.experiments.acting import surprise
from cogmap.experiments.acting.dreamer import Dreamer
from cogmap.experiments.registry import run_experiment


def test_changes_surprise_and_nothing_else(
    dreamer: Dreamer, room: Arena, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert dreamer.trial.conditions.room is room
    rooms = surprise.changed_rooms(room)
    few = {case: rooms[case] for case in ("moved", "kidnapped", "lamp out")}
    monkeypatch.setattr(surprise, "changed_rooms", lambda _: few)
    monkeypatch.setattr(surprise, "VIEWS", 4)
    monkeypatch.setattr(surprise, "UNCHANGED", 32)
    monkeypatch.setitem(dreamer.imagination.__dict__, "threshold", 3.0)
    result = run_experiment("surprise", views=200, room=room)
    figures, cases = result.metrics, result.tables["cases"].set_index("case")
    assert list(cases.index) == list(few)
    assert cases["views"].eq(4).all()
    assert figures["auc_moved"] == cases.loc["moved", "auc"] > 0.95
    assert figures["located_median_m"] == figures["located_moved_m"] == cases.loc["moved", "located_m"]
    assert figures["lamp_out_share"] > 0.3 > cases.loc["moved", "share"]
    assert figures["kidnapped_share"] == cases.loc["kidnapped", "share"] > 0
    assert (figures["unchanged"], figures["threshold"]) == (32, 3.0)
    assert figures["false_alarms"] < 8
    assert result.figures.keys() == result.captions.keys() == {"surprise_moved"}


def test_a_room_without_a_box_is_given_one_beside_its_platform() -> None:
    bare, furnished = Arena.load("open_field"), Arena.load("furnished")
    assert surprise.with_a_box(furnished) is furnished
    (box,) = surprise.with_a_box(bare).boxes
    assert shapely.Polygon(box.outline).distance(bare.walkable) > surprise.SPACE


def test_one_box_is_moved_added_or_removed() -> None:
    room = Arena.load("furnished")
    changed = surprise.changed_rooms(room)
    boxes = [len(changed[case][0].boxes) - len(room.boxes) for case in ("moved", "added", "removed")]
    assert boxes == [0, 1, -1]
    here, there = changed["moved"][1]
    assert np.linalg.norm(here - there) == pytest.approx(surprise.AWAY)
    assert changed["kidnapped"][0].name != room.name
    assert changed["lamp out"][0].boxes == room.boxes
