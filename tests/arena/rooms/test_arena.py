from collections.abc import Callable
from pathlib import Path

import numpy as np
import pymunk
import pytest
import tomli_w

from arena.errors import ArenaError
from arena.rooms.arena import Arena, gallery

NAN, INF = float("nan"), float("inf")
LITTLE = {
    "name": "little",
    "platform": [[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]],
    "walls": [{"start": [0.0, -0.5], "end": [2.0, -0.5], "material": "brick"}],
    "sources": [{"position": [1.0, 0.5]}],
}


def toml(**changes: object) -> str:
    return tomli_w.dumps({name: value for name, value in {**LITTLE, **changes}.items() if value is not None})


def wall(**changes: object) -> list[dict[str, object]]:
    return [{"start": [0.0, 1.0], "end": [1.0, 1.0], "material": "brick", **changes}]


def message(act: Callable[[], object]) -> str:
    with pytest.raises(ArenaError) as error:
        act()
    text = str(error.value)
    assert len(text.splitlines()) == 1
    return text


@pytest.mark.parametrize("name", gallery())
def test_toml_round_trip(name: str, tmp_path: Path) -> None:
    room = Arena.load(name)
    assert Arena.parse(room.to_toml()) == room
    file = tmp_path / "mine.toml"
    file.write_text(room.to_toml(), encoding="utf-8")
    assert Arena.load(file) == Arena.load(str(file)) == room


def test_wheels_and_eyes_agree_on_the_faces() -> None:
    room = Arena.load("pillar")
    faces = room.surfaces
    assert len(faces.start) == 4 + 5 * 4 + 32
    length = np.hypot(*(faces.end - faces.start).T)
    middle = (faces.start + faces.end) / 2
    outwards = np.stack([faces.end[:, 1] - faces.start[:, 1], faces.start[:, 0] - faces.end[:, 0]], axis=1)
    outwards /= length[:, None]
    space, everything = room.space(), pymunk.ShapeFilter()
    for face in range(len(length)):
        for side in (outwards[face], -outwards[face]):
            ray = [tuple(map(float, middle[face] + reach * side)) for reach in (1e-4, -1e-4)]
            assert space.segment_query_first(*ray, 0.0, everything) is not None
    closed = faces.closed
    np.testing.assert_allclose(length[-32:], 2 * 0.5 * np.sin(np.pi / 32))
    # Counter-clockwise: the right-hand side of every face of a solid is outside.
    for index, box in enumerate(room.boxes):
        group = slice(4 + 4 * index, 8 + 4 * index)
        assert closed[group].all()
        assert (((middle[group] - box.center) * outwards[group]).sum(axis=1) > 0).all()
        np.testing.assert_allclose(faces.offset[group], np.cumsum(length[group]) - length[group])


def test_samples_are_free_and_even() -> None:
    room = Arena.load("pillar")
    xy = room.sample_free(4000, 0.18, np.random.default_rng(0))
    assert xy.shape == (4000, 2)
    assert room.is_free(xy, 0.18).all()
    np.testing.assert_array_equal(xy, room.sample_free(4000, 0.18, np.random.default_rng(0)))
    quarters = np.histogram2d(*xy.T, bins=2)[0]
    assert np.abs(quarters / 1000 - 1).max() < 0.1


def test_touching_platforms_are_one() -> None:
    room = Arena.create(
        **{**LITTLE, "platform": [LITTLE["platform"][0], [[2.0, 0.0], [4.0, 0.0], [4.0, 1.0], [2.0, 1.0]]]}
    )
    assert room.is_free(np.array([[2.0, 0.5]]), 0.3).all()
    assert len(room.space().shapes) == 4 + 2 + 1


def test_no_free_space() -> None:
    room = Arena.load("open_field")
    text = message(lambda: room.sample_free(1, 1.5, np.random.default_rng(0)))
    assert text.startswith("arena 'open_field' has no free space for a body of radius 1.5 m")


WRONG = [
    ("", "empty"),
    ("# only a comment\n", "empty"),
    ("name = ", "not TOML"),
    ("\x00", "not TOML"),
    ("a = " + "9" * 5000, "not TOML"),
    ("a = " + "[" * 5000, "not TOML"),
    (toml(colour="red"), "colour"),
    (toml(**{"line\nbreak": 1}), r"'line\nbreak'"),
    (toml(name=None), "name"),
    (toml(platform=[]), "platform"),
    (toml(platform=[[[0.0, 0.0], [1.0, 1.0]]]), "platform"),
    (toml(platform=[[[0, 0], [1, 1], [1, 0], [0, 1]]]), "platform.0: the polygon crosses itself"),
    (toml(platform=[[[0, 0], [1, 1], [2, 2]]]), "platform.0: the polygon crosses itself or is flat"),
    (toml(platform=[[[0, 0], [1, 0], [1, 1], [1, 1]]]), "platform.0: corner 2 and the next are the same"),
    (toml(walls=None), "walls"),
    (toml(walls=[]), "nothing to see"),
    (toml(walls=wall(start=[1.0, 1.0])), "zero length"),
    (toml(walls=wall(material="cheese")), "walls.0.material is 'cheese': unknown material"),
    (toml(walls=wall(height=-1.0)), "height"),
    (toml(walls=wall(end=[1.0, NAN])), "walls.0.end.1"),
    (toml(boxes=[{"center": [0.0, 0.0], "size": [1.0, 0.0], "material": "oak"}]), "boxes.0.size.1"),
    (toml(pillars=[{"center": [0.0, 0.0], "radius": INF, "material": "oak"}]), "pillars.0.radius"),
    (toml(sources=[{"position": [1.0, -0.5]}]), "odour source 0 at (1.0, -0.5) is inside a wall"),
    (
        toml(pillars=[{"center": [1.0, 0.5], "radius": 0.2, "material": "oak"}]),
        "odour source 0 at (1.0, 0.5) is inside a wall or solid",
    ),
    (
        toml(blocks=[{"corners": [[0.5, 0.0], [1.5, 0.0], [1.0, 0.9]], "material": "oak"}]),
        "odour source 0 at (1.0, 0.5) is inside a wall or solid",
    ),
    (toml(sources=[{"position": [1, 0.5]}, {"position": [2.1, 1]}]), "source 1 at (2.1, 1.0) is outside"),
    (toml(decay_length=0.0), "decay_length"),
    (toml(decay_length="far"), "decay_length is 'far': Input should be a valid number"),
    (toml(sources=3), "sources is 3: Input should be a list"),
    (toml(boxes=[3]), "boxes.0 is 3: Input should be a table"),
    (toml(floor=[1, 2, 256]), "floor.2 is 256: "),
    (toml(floor=[1, 2]), "floor.2: Field required"),
    (toml(floor="lava"), "floor is 'lava': unknown material"),
    (toml(zenith=[1, 2, 3.5]), "zenith.2 is 3.5"),
    (toml(light={"azimuth_deg": 10.0, "elevation_deg": 90.0}), "light.elevation_deg is 90.0: "),
    ("ceiling = [0x" + 5000 * "F" + ", 1, 2]\n" + toml(), "ceiling.0: Input should be less than"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "says"), WRONG, ids=[says for _, says in WRONG])
def test_what_is_wrong_is_said_in_one_line(text: str, says: str) -> None:
    assert says in message(lambda: Arena.parse(text))


def test_broken_toml_names_the_line() -> None:
    assert "(at line 3, column 8)" in message(lambda: Arena.parse("name = 'a'\n\nfloor =\n"))


def test_solids_are_in_the_way_of_wheels_eyes_and_noses() -> None:
    hook = [[0.6, 0.2], [1.4, 0.2], [1.4, 0.8], [1.2, 0.8], [1.2, 0.4], [0.6, 0.4]]
    parts = {
        "boxes": [{"center": [0.3, 0.5], "size": [0.2, 0.2], "material": "oak"}],
        "pillars": [{"center": [1.8, 0.5], "radius": 0.1, "material": "oak"}],
        "blocks": [{"corners": hook, "material": "oak"}],
    }
    room = Arena.create(**{**LITTLE, "sources": [{"position": [1.0, 0.6]}], **parts})
    assert room.solids == (*room.boxes, *room.pillars, *room.blocks)
    assert room.obstacles.area == pytest.approx(0.04 + 16 * 0.01 * np.sin(np.pi / 16) + 0.24)
    assert room.walkable.area == 2
    assert room.is_free(np.array([[1.0, 0.6], [1.3, 0.6], [1.0, 0.3]]), 0.1).tolist() == [True, False, False]
    assert len(room.space().shapes) == 4 + 1 + 4 + 32 + 6
    # Within the hook it smells stronger than as far behind its arm.
    near, behind = room.odours.concentration(np.array([[1.0, 0.8], [1.6, 0.6]]))[:, 0]
    assert near > 1.5 * behind


def test_a_copy_is_a_room_of_its_own() -> None:
    room = Arena.parse(toml())
    assert room.free_space(0.1).area == pytest.approx(1.8 * 0.8)
    wider = room.model_copy(update={"platform": [[(0, 0), (3, 0), (3, 1), (0, 1)]]})
    assert wider.free_space(0.1).area == pytest.approx(2.8 * 0.8)
    assert wider.walls == room.walls
    assert "odour source 0" in message(lambda: room.model_copy(update={"walls": wall(start=[1.0, 0.5])}))


def test_free_space_too_scattered_to_find() -> None:
    corners = [[[x, x], [x + 0.5, x], [x, x + 0.5]] for x in (-900.0, 900.0)]
    text = message(
        lambda: Arena.create(**{**LITTLE, "platform": corners}).sample_free(1, 0.1, np.random.default_rng(0))
    )
    assert "scattered over" in text


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    assert (
        "no room 'atlantis' in the gallery; choose one of blue_wall, cue_cylinder, cue_square, furnished"
        in message(lambda: Arena.load("atlantis"))
    )
    assert "cannot read" in message(lambda: Arena.load(tmp_path / "missing.toml"))
    (tmp_path / "folder.toml").mkdir()
    assert "cannot read" in message(lambda: Arena.load(tmp_path / "folder.toml"))
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    assert "not UTF-8" in message(lambda: Arena.load(tmp_path / "bytes.toml"))
    (tmp_path / "empty.toml").write_text("")
    assert "empty.toml: the TOML is empty" in message(lambda: Arena.load(tmp_path / "empty.toml"))


def test_outlines_may_repeat_their_first_corner() -> None:
    corners, made_of = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], ["brick", "oak", "oak"]
    one, other = (
        Arena.parse(toml(platform=[ring], blocks=[{"corners": ring, "material": made_of}], sources=None))
        for ring in (corners, [*corners, corners[0]])
    )
    assert one == other


def test_a_byte_order_mark_is_no_text(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(toml(), encoding="utf-8-sig")
    assert Arena.load(file) == Arena.parse(toml()) == Arena.parse("\ufeff" + toml())


def test_a_tilde_is_the_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "mine.toml").write_text(toml(), encoding="utf-8")
    assert Arena.load("~/mine.toml") == Arena.parse(toml())
    assert "home that is not known" in message(lambda: Arena.load("~nobody-of-this-name/mine.toml"))


def test_numbers_may_be_numpys() -> None:
    room = Arena.create(
        name="numpy",
        platform=[np.array(LITTLE["platform"][0])],
        walls=[{"start": np.zeros(2), "end": np.float32([1, 0]), "material": "brick"}],
        floor=np.array([1, 2, 3], np.uint8),
    )
    assert Arena.parse(room.to_toml()) == room
    assert type(room.floor[0]) is int
    assert room.is_free([[1.0, 0.5], [9.0, 9.0]], 0.1).tolist() == [True, False]


def test_solids_that_coincide_stop_a_body_as_one_does() -> None:
    pillar = {"center": [1.0, 0.5], "radius": 0.2, "material": "brick"}
    one, many = (Arena.parse(toml(sources=None, pillars=[pillar] * count)) for count in (1, 500))
    np.testing.assert_array_equal(one.edges, many.edges)
