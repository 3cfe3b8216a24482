from pathlib import Path
from typing import Any

import pytest

from arena import Arena, ArenaError, Camera, Cyclic, Nose
from cogmap import CogmapError, Plan
from cogmap.sweeps.points import Point, points_of


def point(**given: Any) -> Point:
    return points_of(Plan.create(experiment="toy", points=[given]))[0]


def test_every_parameter_reaches_its_place() -> None:
    sources = [{"position": [0.0, 1.0]}]
    found = point(
        **{
            "arena": "pillar", "arena.decay_length": 2, "arena.sources": sources, "views": 300,
            "motion": "cyclic", "motion.passes": 6, "camera": "perspective", "camera.width": 64,
            "nose.noise": 0.3, "map.place_cells": 50,
        }
    )  # fmt: skip
    assert found.room == Arena.load("pillar").model_copy(update={"decay_length": 2.0, "sources": sources})
    assert found.views == 300
    assert found.overrides == {
        "motion": Cyclic(passes=6),
        "camera": Camera.perspective(width=64),
        "nose": Nose(noise=0.3),
        "map": {"place_cells": 50},
    }


def test_the_experiment_says_what_is_not_told() -> None:
    found = point(**{"camera.width": 90})
    assert (found.room.name, found.views, found.seed) == ("furnished", 200, 0)
    assert found.overrides == {"camera": Camera.panoramic(width=90)}


def test_seeds_repeat_every_point() -> None:
    plan = Plan.create(experiment="toy", seeds=[3, 5], grid={"arena": ["pillar", "furnished"]})
    assert [(one.varied["arena"], one.seed) for one in points_of(plan)] == [
        ("pillar", 3), ("pillar", 5), ("furnished", 3), ("furnished", 5)
    ]  # fmt: skip


def test_the_digest_is_of_what_matters(tmp_path: Path) -> None:
    file = tmp_path / "room.toml"
    file.write_text(Arena.load("pillar").to_toml(), encoding="utf-8")
    assert point(arena=str(file)).digest == point(arena="pillar").digest
    file.write_text(Arena.load("furnished").to_toml(), encoding="utf-8")
    assert point(arena=str(file)).digest != point(arena="pillar").digest
    every = [
        {"views": 300},
        {"nose.noise": 0.2},
        {"map.charts": 50},
        {"motion": "cyclic"},
        {"camera.width": 9},
    ]
    assert len({point(**one).digest for one in every} | {point(arena="furnished").digest}) == 6


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"nose.nois": 1}, "unknown parameter 'nose.nois'; did you mean 'nose.noise'"),
        ({"map.maps": 1}, "did you mean 'map"),
        ({"camera.projection": "x"}, "unknown parameter 'camera.projection'"),
        ({"motion": "track", "motion.spin": 1.0}, "unknown parameter 'motion.spin'"),
        ({"room": "pillar"}, "unknown parameter 'room'"),
        ({"nose": {"noise": 0.1}}, "unknown parameter 'nose'; choose one of nose.noise"),
        ({"map.seed": 1}, "unknown parameter 'map.seed'"),
        ({"motion": "swim"}, "unknown motion 'swim'"),
        ({"camera": 3}, "unknown camera '3'"),
        ({"arena": 3}, "arena is 3"),
        ({"map.charts": 1.5}, "map.charts is 1.5"),
        ({"views": 10}, "views is 10"),
    ],
)
def test_what_is_not_known_is_said(given: dict[str, Any], says: str) -> None:
    with pytest.raises(CogmapError, match=says):
        point(**given)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"nose.noise": "much"}, "noise is 'much'"),
        ({"camera.width": 0}, "width"),
        ({"arena": "atlantis"}, "no room 'atlantis'"),
        ({"arena.decay_length": -1.0}, "decay_length is -1"),
    ],
)
def test_what_a_part_cannot_have_is_said(given: dict[str, Any], says: str) -> None:
    with pytest.raises(ArenaError, match=says):
        point(**given)


@pytest.mark.parametrize(
    ("name", "given", "says"),
    [
        ("levitation", {"views": 300}, "unknown experiment 'levitation'"),
        ("rotation", {"nose.noise": 0.1}, "rotation does not take 'nose.noise'; it takes views, arena"),
        ("at_home", {"arena.name": "x"}, "leave 'arena.name' out"),
    ],
)
def test_what_an_experiment_does_not_take_is_refused(name: str, given: dict[str, Any], says: str) -> None:
    with pytest.raises(CogmapError, match=says):
        points_of(Plan.create(experiment=name, points=[given]))


def test_the_same_point_twice_is_refused() -> None:
    with pytest.raises(CogmapError, match="is the same as"):
        points_of(Plan.create(experiment="toy", grid={"nose.noise": [0.1, 0.1]}))


def test_an_experiment_of_several_rooms_keeps_them_unless_one_is_given() -> None:
    grid: dict[str, Any] = {"views": [300, 400]}
    assert not points_of(Plan.create(experiment="homology", grid=grid))[0].any_room
    assert points_of(Plan.create(experiment="homology", grid=grid, set={"arena": "pillar"}))[0].any_room
