import json
import tomllib
from importlib import resources
from typing import Any

import jsonschema
import pytest
import tomli_w
from hypothesis import given, settings

from arena.errors import ArenaError
from arena.rooms.arena import Arena, gallery
from arena.rooms.materials import materials
from tests.arena import strategies

SCHEMA = Arena.json_schema()
CHECK = jsonschema.Draft202012Validator(SCHEMA)


def fields(name: str) -> dict[str, Any]:
    file = resources.files("arena") / "gallery" / f"{name}.toml"
    return tomllib.loads(file.read_text(encoding="utf-8"))


def test_it_is_a_schema_of_the_latest_draft() -> None:
    CHECK.check_schema(SCHEMA)
    assert SCHEMA["$schema"].endswith("draft/2020-12/schema")
    assert json.loads(json.dumps(SCHEMA)) == SCHEMA


@pytest.mark.parametrize("name", gallery())
def test_every_room_of_the_gallery_is_valid(name: str) -> None:
    CHECK.validate(fields(name))


@settings(deadline=None, max_examples=30)
@given(strategies.arenas())
@pytest.mark.filterwarnings("ignore:Do not use the `random` module")
def test_every_arena_is_valid(room: Arena) -> None:
    CHECK.validate(tomllib.loads(room.to_toml()))


WALL = {"start": [0, 0], "end": [1, 1], "material": "brick"}
BOX = {"center": [0, 0], "size": [1, 1], "material": "oak"}


@pytest.mark.parametrize(
    ("wrong", "at"),
    [
        ({"sofa": 3}, ""),
        ({"name": ""}, "name"),
        ({"name": 3}, "name"),
        ({"platform": []}, "platform"),
        ({"platform": [[[0, 0], [1, 1]]]}, "platform.0"),
        ({"platform": [[[0, 0], [1, 1], [1, 0, 0]]]}, "platform.0.2"),
        ({"walls": [{**WALL, "material": "cheese"}]}, "walls.0.material"),
        ({"walls": [{**WALL, "height": 0}]}, "walls.0.height"),
        ({"walls": [{**WALL, "height": "high"}]}, "walls.0.height"),
        ({"walls": [{**WALL, "heigth": 1}]}, "walls.0"),
        ({"walls": [{"start": [0, 0], "end": [1, 1]}]}, "walls.0"),
        ({"boxes": [BOX, {**BOX, "size": [-1, 1]}]}, "boxes.1.size.0"),
        ({"boxes": [{**BOX, "material": ["oak", "oak", "oak"]}]}, "boxes.0.material"),
        ({"pillars": [{"center": [0, 0], "radius": True, "material": "oak"}]}, "pillars.0.radius"),
        ({"blocks": [{"corners": [[0, 0], [1, 0]], "material": "oak"}]}, "blocks.0.corners"),
        ({"sources": [[0, 0]]}, "sources.0"),
        ({"floor": "lava"}, "floor"),
        ({"floor": [1, 2, 256]}, "floor"),
        ({"zenith": [1, 2]}, "zenith"),
        ({"light": {"azimuth_deg": 0, "elevation_deg": 90}}, "light.elevation_deg"),
        ({"decay_length": -1}, "decay_length"),
    ],
)
def test_mistakes_are_found_where_the_arena_finds_them(wrong: dict[str, Any], at: str) -> None:
    room = {**fields("open_field"), **wrong}
    (error,) = CHECK.iter_errors(room)
    assert ".".join(map(str, error.absolute_path)) == at
    with pytest.raises(ArenaError, match=f"^{at}"):
        Arena.parse(tomli_w.dumps(room))


@pytest.mark.parametrize("key", ["name", "platform", "walls"])
def test_what_must_be_given(key: str) -> None:
    room = fields("furnished")
    del room[key]
    assert not CHECK.is_valid(room)


def test_everything_is_described_and_nothing_twice() -> None:
    models = [SCHEMA, *(part for part in SCHEMA["$defs"].values() if part.get("type") == "object")]
    assert [model["title"] for model in models] == [
        "Arena", "Block", "Box", "Light", "Pillar", "Source", "Wall"
    ]  # fmt: skip
    for model in models:
        assert model["description"].endswith(".")
        assert "\n\n" not in model["description"]
        for key, value in model["properties"].items():
            assert value["description"].endswith("."), key
            assert "title" not in value
            assert value.get("default", 0) is not None
    assert SCHEMA["$defs"]["Material"]["enum"] == list(materials())
    assert json.dumps(SCHEMA).count('"cardboard"') == 1
