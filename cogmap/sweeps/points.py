"""Points of a sweep: parameters by name turned into what an experiment is called with."""

from __future__ import annotations

import hashlib
import inspect
import json
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property
from typing import Any, TypeVar

from arena import Arena, Camera, Nose
from arena.bodies.catalogue import bodies
from arena.motions.catalogue import motions
from cogmap.errors import CogmapError
from cogmap.experiments.registry import FEWEST, Experiment, experiments
from cogmap.inputs import check_choice, checked_count
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.sweeps.plan import Plan, Shown

T = TypeVar("T")


@dataclass(frozen=True)
class Point:
    """One experiment: where, how much of it, with which seed and with what that differs."""

    experiment: str
    varied: dict[str, Shown]
    """What the table says of it."""
    seed: int
    views: int
    room: Arena
    any_room: bool
    """Whether the experiment is told the room; else it takes its own, or all of its own."""
    overrides: dict[str, Any]
    """`nose`, `motion`, `camera`, `body` and `map`, where they are given."""

    @cached_property
    def described(self) -> dict[str, Any]:
        """All that the outcome depends on, as JSON knows it."""
        parts = {
            name: part if name == "map" else {"kind": type(part).__name__, **part.model_dump(mode="json")}
            for name, part in self.overrides.items()
        }
        room = self.room.model_dump(mode="json", exclude_defaults=True)
        return {
            "experiment": self.experiment,
            "arena": room,
            "views": self.views,
            "seed": self.seed,
            **parts,
        }

    @cached_property
    def digest(self) -> str:
        """Name of all that the outcome depends on."""
        return hashlib.sha256(json.dumps(self.described, sort_keys=True).encode()).hexdigest()[:32]


def points_of(plan: Plan) -> list[Point]:
    """Give every point of a plan with every seed, in order.

    Raises
    ------
    ArenaError, CogmapError
        For an unknown experiment or parameter, something the experiment does not take, values that cannot be,
        or two points that are the same.
    """
    check_choice("experiment", plan.experiment, tuple(experiments()))
    common = dict(plan.fixed) if plan.views is None else {**plan.fixed, "views": plan.views}
    found: dict[str, Point] = {}
    for index, assignment in enumerate(plan.assignments()):
        given = {**common, **{name: choice.value for name, choice in assignment.items()}}
        where = _settle(plan.experiment, experiments()[plan.experiment], given)
        shown = {name: choice.shown for name, choice in assignment.items()}
        for seed in plan.seeds:
            point = Point(experiment=plan.experiment, varied=shown, seed=seed, **where)
            if point.digest in found:
                twin = found[point.digest].varied
                raise CogmapError(f"point {index}, {shown}, is the same as {twin}; give each point once")
            found[point.digest] = point
    return list(found.values())


def _settle(name: str, chosen: Experiment, given: Mapping[str, Any]) -> dict[str, Any]:
    """Turn parameters into the arguments of a point that it does not share with the rest of its sweep."""
    families = {part.split(".")[0] for part in given}
    build: dict[str, Callable[[Mapping[str, Any]], Any]] = {
        "motion": lambda given: _chosen(given, "motion", motions(), "brownian"),
        "camera": _camera,
        "body": lambda given: _chosen(given, "body", bodies(), "disc"),
        "nose": lambda given: Nose(**_fields(given, "nose", Nose.model_fields)),
        "map": _map,
    }
    unknown = families - {"views", "arena", *build}
    if unknown:
        known = ["views", "arena", "motion", "camera", "body", "nose.noise", "map.charts"]
        raise _unknown(next(part for part in given if part.split(".")[0] in unknown), known)
    if "arena" in families and not chosen.any_room:
        raise CogmapError(f"{name} takes place in rooms of its own; leave {_first(given, 'arena')} out")
    for family in build:
        if family in families and family not in chosen.takes:
            takes = ", ".join(("views", *(["arena"] if chosen.any_room else []), *chosen.takes))
            raise CogmapError(f"{name} does not take {_first(given, family)}; it takes {takes}")
    return {
        "views": checked_count("views", given.get("views", chosen.views), FEWEST),
        "room": _room(given, chosen),
        "any_room": "arena" in families,
        "overrides": {family: build[family](given) for family in build if family in families},
    }


def _room(given: Mapping[str, Any], chosen: Experiment) -> Arena:
    source = given.get("arena", chosen.room)
    if not isinstance(source, str):
        raise CogmapError(f"arena is {source!r}; give the name of a room or the path of a TOML file")
    room = Arena.load(source)
    changes = _fields(given, "arena", Arena.model_fields)
    return room.model_copy(update=changes) if changes else room


def _chosen(given: Mapping[str, Any], family: str, kinds: Mapping[str, Callable[..., T]], usual: str) -> T:
    """Make what a registry has under the name that is given."""
    kind = str(given.get(family, usual))
    check_choice(family, kind, tuple(kinds))
    return kinds[kind](**_fields(given, family, inspect.signature(kinds[kind]).parameters))


def _camera(given: Mapping[str, Any]) -> Camera:
    kind = str(given.get("camera", "panoramic"))
    check_choice("camera", kind, ("panoramic", "perspective"))
    usual = (Camera.panoramic if kind == "panoramic" else Camera.perspective)().model_dump()
    return Camera(
        **usual | _fields(given, "camera", [name for name in Camera.model_fields if name != "projection"])
    )


def _map(given: Mapping[str, Any]) -> dict[str, int]:
    known = [name for name in inspect.signature(CognitiveMap).parameters if name != "seed"]
    return {name: checked_count(f"map.{name}", value) for name, value in _fields(given, "map", known).items()}


def _fields(given: Mapping[str, Any], family: str, known: Collection[str]) -> dict[str, Any]:
    """Give what is told of a family by the names of its fields, all of which must be known."""
    found = {}
    for name, value in given.items():
        start, _, key = name.partition(".")
        if start != family or name in ("arena", "motion", "camera", "body"):
            continue
        if key not in known:
            raise _unknown(name, [f"{family}.{item}" for item in known])
        found[key] = value
    return found


def _unknown(name: str, known: list[str]) -> CogmapError:
    near = get_close_matches(name, known, n=1)
    hint = f"did you mean {near[0]!r}?" if near else f"choose one of {', '.join(known)}"
    return CogmapError(f"unknown parameter {name!r}; {hint}")


def _first(given: Mapping[str, Any], family: str) -> str:
    return repr(next(name for name in given if name.split(".")[0] == family))
