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
    monkeypatch.setattr(surprise, "VIEWS", 8)
    monkeypatch.setattr(surprise, "UNCHANGED", 20)
    monkeypatch.setattr("cogmap.imagination.imagination.CALIBRATED", 12)
    result = run_experiment("surprise", views=200, room=room)
    figures, cases = result.metrics, result.tables["cases"].set_index("case")
    assert list(cases.index) == ["moved", "added", "removed", "kidnapped", "lamp out"]
    assert cases["views"].eq(8).all()
    for case in ("moved", "added", "removed"):
        assert figures[f"auc_{case}"] == cases.loc[case, "auc"] > 0.8
    assert figures["located_median_m"] == np.median(cases["located_m"].dropna())
    assert figures["kidnapped_share"] > 0.3 > cases.loc["moved", "share"]
    assert figures["unchanged"] == 20
    assert figures["false_alarms"] <= 2
    assert result.figures.keys() == {f"surprise_{case}" for case in ("moved", "added", "removed")}


def test_a_room_without_a_box_is_given_one_beside_its_platform() -> None:
    bare, furnished = Arena.load("open_field"), Arena.load("furnished")
    assert surprise.with_a_box(furnished) is furnished
    (box,) = surprise.with_a_box(bare).boxes
    assert shapely.Polygon(box.outline).distance(bare.walkable) > surprise.SPACE


def test_one_box_is_moved_added_or_removed() -> None:
    room = Arena.load("furnished")
    changed = surprise.changed_rooms(room)
    count = len(room.boxes)
    assert [len(changed[case][0].boxes) for case in ("moved", "added", "removed")] == [count, count + 1, count - 1]
    here, there = changed["moved"][1]
    assert np.linalg.norm(here - there) == pytest.approx(surprise.AWAY)
    assert changed["kidnapped"][0].name != room.name
    assert changed["lamp out"][0].boxes == room.boxes
