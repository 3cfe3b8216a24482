import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pymunk
import pytest
import tomli_w
from hypothesis import given, settings
from hypothesis import strategies as st

from arena.arena import Arena, gallery
from arena.errors import ArenaError
from arena.materials import MATERIALS

GALLERY = ["furnished", "open_field", "pillar"]
NAN, INF = float("nan"), float("inf")
LITTLE = {
    "name": "little",
    "platform": [[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]],
    "walls": [{"start": [0.0, -0.5], "end": [2.0, -0.5], "material": "brick"}],
    "sources": [{"position": [1.0, 0.5]}],
}
ELBOW = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]]


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


def test_gallery_is_the_rooms_of_the_design() -> None:
    assert gallery() == GALLERY
    rooms = {name: Arena.load(name) for name in GALLERY}
    for name, room in rooms.items():
        assert room.name == name
        assert room.free_space(0.0).area == pytest.approx(
            12 - (name == "pillar") * 16 * 0.25 * np.sin(np.pi / 16)
        )
        assert [source.position for source in room.sources] == [(-1.5, -1.0), (1.6, 0.9), (1.2, -1.1)]
        assert len({wall.material for wall in room.walls}) == 4
        assert room.decay_length == 1.5
        np.testing.assert_allclose(room.bounds, (-3, -2.5, 3, 2.5), atol=0.02)
    assert [len(rooms[name].boxes) for name in GALLERY] == [5, 0, 5]
    assert rooms["pillar"].boxes == rooms["furnished"].boxes
    assert (rooms["pillar"].pillars[0].center, rooms["pillar"].pillars[0].radius) == ((0, 0), 0.5)
    # Furniture stands off the platform.
    assert rooms["furnished"].free_space(0.18).equals(rooms["open_field"].free_space(0.18))


@pytest.mark.parametrize("name", GALLERY)
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


def brute_clearance(room: Arena, xy: np.ndarray, ring: np.ndarray) -> np.ndarray:
    """Distance from each point to the nearest edge of anything; −1 off the platform and in solids."""
    closed = [np.vstack([solid.outline, solid.outline[:1]]) for solid in (*room.boxes, *room.pillars)]
    closed.append(np.vstack([ring, ring[:1]]))
    chains = [*closed, *(np.array([wall.start, wall.end]) for wall in room.walls)]
    edges = np.concatenate([np.stack([chain[:-1], chain[1:]], axis=1) for chain in chains])
    along = edges[:, 1] - edges[:, 0]
    share = np.clip(((xy[:, None] - edges[:, 0]) * along).sum(-1) / (along**2).sum(-1), 0, 1)
    distance = np.linalg.norm(xy[:, None] - edges[:, 0] - share[..., None] * along, axis=-1).min(axis=1)

    def inside(chain: np.ndarray) -> np.ndarray:
        a, b = chain[:-1], chain[1:]
        spans = (a[:, 1] > xy[:, None, 1]) != (b[:, 1] > xy[:, None, 1])
        rise = np.where(b[:, 1] == a[:, 1], 1, b[:, 1] - a[:, 1])
        x = a[:, 0] + (xy[:, None, 1] - a[:, 1]) / rise * (b[:, 0] - a[:, 0])
        return (spans & (x > xy[:, None, 0])).sum(axis=1) % 2 == 1

    *solids, platform = closed
    solid = np.any([inside(chain) for chain in solids], axis=0) if solids else False
    return np.where(inside(platform) & ~solid, distance, -1)


@settings(deadline=None, max_examples=20)
@given(radius=st.floats(0.01, 0.4), seed=st.integers(0, 999), name=st.sampled_from(["pillar", "elbow"]))
def test_free_space_is_where_nothing_is_nearer_than_the_radius(radius: float, seed: int, name: str) -> None:
    box = {"center": (0.5, 2.0), "size": (0.3, 0.2), "angle_deg": 30.0, "material": "oak"}
    wall = {"start": (1.5, 0.3), "end": (2.2, 0.8), "material": "brick"}
    room = Arena.create(name="elbow", platform=[ELBOW], walls=[wall], boxes=[box])
    room = Arena.load("pillar") if name == "pillar" else room
    xy = np.random.default_rng(seed).uniform([-2.2, -2], [3.2, 3.2], (2000, 2))
    clearance = brute_clearance(room, xy, np.array(room.platform[0]))
    # Round corners are drawn as polygons.
    clear = np.abs(clearance - radius) > 1e-3
    np.testing.assert_array_equal(room.is_free(xy, radius)[clear], (clearance > radius)[clear])


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
    (toml(platform=[[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]]), "crosses itself"),
    (toml(walls=None), "walls"),
    (toml(walls=[]), "nothing to see"),
    (toml(walls=wall(start=[1.0, 1.0])), "zero length"),
    (toml(walls=wall(material="cheese")), "unknown material 'cheese'"),
    (toml(walls=wall(height=-1.0)), "height"),
    (toml(walls=wall(end=[1.0, NAN])), "walls.0.end.1"),
    (toml(boxes=[{"center": [0.0, 0.0], "size": [1.0, 0.0], "material": "oak"}]), "boxes.0.size.1"),
    (toml(pillars=[{"center": [0.0, 0.0], "radius": INF, "material": "oak"}]), "pillars.0.radius"),
    (toml(sources=[{"position": [1.0, -0.5]}]), "odour source 0 at (1.0, -0.5) is inside a wall"),
    (
        toml(pillars=[{"center": [1.0, 0.5], "radius": 0.2, "material": "oak"}]),
        "odour source 0 at (1.0, 0.5) is inside a wall",
    ),
    (toml(decay_length=0.0), "decay_length"),
    (toml(floor=[1, 2, 256]), "floor.2"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "says"), WRONG, ids=[says for _, says in WRONG])
def test_what_is_wrong_is_said_in_one_line(text: str, says: str) -> None:
    assert says in message(lambda: Arena.parse(text))


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    assert "no room 'atlantis' in the gallery; choose one of furnished" in message(
        lambda: Arena.load("atlantis")
    )
    assert "cannot read" in message(lambda: Arena.load(tmp_path / "missing.toml"))
    (tmp_path / "folder.toml").mkdir()
    assert "cannot read" in message(lambda: Arena.load(tmp_path / "folder.toml"))
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    assert "not UTF-8" in message(lambda: Arena.load(tmp_path / "bytes.toml"))
    (tmp_path / "empty.toml").write_text("")
    assert "empty.toml: the TOML is empty" in message(lambda: Arena.load(tmp_path / "empty.toml"))


def check_valid_or_refused(text: str) -> None:
    try:
        room = Arena.parse(text)
    except ArenaError as error:
        complaint = str(error)
    else:
        complaint = None
    if complaint is not None:
        assert len(complaint.splitlines()) == 1
        return
    assert Arena.parse(room.to_toml()) == room
    assert np.isfinite(room.bounds).all()
    assert len(room.surfaces.start) > 0
    assert room.space().shapes
    room.free_space(0.18)


VALUES = st.one_of(
    st.floats(),
    st.integers(-(2**63), 2**63 - 1),
    st.booleans(),
    st.text(max_size=3),
    st.sampled_from(sorted(MATERIALS)),
    st.lists(st.floats(-3, 3), max_size=4),
    st.lists(st.lists(st.floats(-3, 3), min_size=2, max_size=2), max_size=5),
    st.dates(),
)


@settings(deadline=None, max_examples=150)
@given(st.data())
def test_mutated_rooms_are_valid_or_refused(data: st.DataObject) -> None:
    room = tomllib.loads(Arena.load("pillar").to_toml())
    part: dict[object, object] | list[object] = room
    while True:
        keys = list(part) if isinstance(part, dict) else list(range(len(part)))
        key = data.draw(st.sampled_from(keys))
        if not isinstance(part[key], dict | list) or not part[key] or data.draw(st.integers(0, 5)) == 0:
            break
        part = part[key]
    match data.draw(st.sampled_from(["replace", "remove", "double", "add"])):
        case "replace":
            part[key] = data.draw(VALUES)
        case "remove":
            del part[key]
        case "double" if isinstance(part, list):
            part.append(part[key])
        case _ if isinstance(part, dict):
            part[data.draw(st.text(min_size=1, max_size=3))] = part[key]
    check_valid_or_refused(tomli_w.dumps(room))


@settings(deadline=None, max_examples=150)
@given(st.data())
def test_garbled_toml_is_valid_or_refused(data: st.DataObject) -> None:
    text = Arena.load("open_field").to_toml()
    start = data.draw(st.integers(0, len(text)))
    stop = data.draw(st.integers(start, min(len(text), start + 8)))
    check_valid_or_refused(text[:start] + data.draw(st.text(max_size=4)) + text[stop:])
