import base64
import json

import cv2
import numpy as np
import pytest

from cogmap.pages.live.pictures import MOST, data_url, heat, packed
from cogmap.pages.live.player import Player, understood
from cogmap.pages.live.scenery import scenery
from cogmap.pages.live.session import Session
from cogmap.pages.live.world import World


def picture(url: str) -> np.ndarray:
    _, text = url.split(",")
    jpeg = cv2.imdecode(np.frombuffer(base64.b64decode(text), np.uint8), cv2.IMREAD_COLOR)
    return np.asarray(jpeg)[:, :, ::-1]


def test_a_click_gives_all_panels_and_then_nothing_until_something_changes(session: Session) -> None:
    player = Player(session)
    first = player.turn(0.0, anew=True)
    assert first is not None
    player.hear({"stand": [0.5, -0.2], "heading": 1.0, "act": 7})
    update = player.turn(0.02)
    assert update is not None
    shown = json.loads(json.dumps(update.frame, allow_nan=False))
    np.testing.assert_allclose(shown["pose"], (0.5, -0.2, 1.0), atol=1e-3)
    assert shown["act"] == 7
    assert all(shown[name] for name in ("seen", "dream", "surprise", "place", "heading", "near", "point"))
    assert shown["errors"]["m"] < 0.1
    seen = session.look().view
    assert np.abs(picture(shown["seen"]).astype(float) - seen).mean() < 6
    assert player.turn(0.02) is None


def test_dreams_of_a_way_are_sent_once_each(session: Session) -> None:
    player = Player(session)
    session.stand(-1.0, -0.6, 0.0)
    player.hear({"goal": [1.0, 0.4], "heading": 0.5})
    sent: list[str] = []
    for _ in range(20):
        update = player.turn(0.01)
        if update is not None:
            assert update.first == len(sent)
            sent += update.dreamt
    assert len(sent) == len(session.dreamt) > 2
    assert sent == [data_url(view) for view in session.dreamt]


def test_a_moved_box_sends_the_room_anew(session: Session) -> None:
    player = Player(session)
    player.turn(0.0)
    player.hear({"box": 0, "place": [-1.2, 1.9]})
    moved = player.turn(0.0)
    assert moved is not None
    assert moved.room is not None
    assert np.mean(moved.room["solids"][0]["outline"], axis=0) == pytest.approx((-1.2, 1.9))
    player.do(lambda other: other.tidy())
    back = player.turn(0.0)
    assert back is not None
    assert back.room is not None
    assert back.room["solids"] == scenery(session.world)["room"]["solids"]


@pytest.mark.parametrize(
    "said",
    [
        None,
        [],
        "stand",
        {},
        {"stand": [1]},
        {"stand": ["a", "b"]},
        {"stand": [float("nan"), 0]},
        {"drive": [float("inf"), 0]},
        {"goal": None},
        {"box": "0", "place": [0, 0]},
        {"box": 0, "place": [0]},
    ],
)
def test_what_is_not_understood_is_left(said: object) -> None:
    assert understood(said) is None


def test_the_scenery_is_json_and_lies_in_the_room(world: World) -> None:
    told = json.loads(json.dumps(scenery(world), allow_nan=False))
    x0, y0, x1, y1 = world.room.bounds
    for name, columns in (("charts", [0, 1]), ("metric", [0, 1]), ("roadmap", [2, 3])):
        points = np.array(told[name])[:, columns]
        assert len(points) > 100
        assert (points > (x0, y0)).all()
        assert (points < (x1, y1)).all()
    fields = told["fields"]
    rows, columns = fields["shape"]
    data = np.frombuffer(base64.b64decode(fields["data"]), np.uint8)
    assert data.size == fields["cells"] * rows * columns
    assert len(told["preferred"]["place"]) == fields["cells"] == 150
    assert len(told["room"]["odours"]) == len(world.room.sources)
    poses = np.frombuffer(base64.b64decode(told["embedding"]["poses"]), np.float32).reshape(-1, 3)
    np.testing.assert_allclose(poses, world.poses[world.mind.shown], atol=1e-5)


def test_the_odour_contours_are_where_it_smells_so(world: World) -> None:
    for index, odour in enumerate(scenery(world)["room"]["odours"]):
        for line in odour["lines"]:
            smelt = np.log2(world.room.odours.concentration(np.array(line))[:, index])
            assert np.abs(smelt - np.round(np.median(smelt))).max() < 0.3


def test_the_metric_map_and_the_cells_lie_where_they_are(world: World) -> None:
    metric = np.array(scenery(world)["metric"])
    lengths = np.hypot(metric[:, 2] - metric[:, 0], metric[:, 3] - metric[:, 1])
    assert np.median(lengths) == pytest.approx(0.25, abs=0.03)
    charts = np.array(scenery(world)["charts"])
    assert np.isfinite(charts).all()
    places = np.array(scenery(world)["preferred"]["place"])
    assert (np.abs(places) < (2.0, 1.5)).all()


def test_surprise_is_dark_as_usual_and_bright_at_most() -> None:
    painted = heat(np.array([[0.0, MOST, 10 * MOST]], np.float32)).astype(int).sum(axis=2)[0]
    assert painted[0] < 20
    assert painted[1] == painted[2] > 500


def test_arrays_are_packed_as_their_bytes() -> None:
    values = np.arange(12, dtype=np.float32).reshape(3, 4)[:, ::2]
    np.testing.assert_array_equal(np.frombuffer(base64.b64decode(packed(values)), np.float32), values.ravel())
