"""Points of a sweep: parameters by name turned into what an experiment is called with."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from arena import Arena
from cogmap.errors import CogmapError
from cogmap.experiments.parameters import FAMILIES, build, by_family, fields_of, unknown
from cogmap.experiments.registry import FEWEST, Experiment, experiments
from cogmap.inputs import check_choice, checked_count
from cogmap.sweeps.plan import Plan, Shown


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
        return {
            "experiment": self.experiment,
            "arena": self.room.model_dump(mode="json", exclude_defaults=True),
            "views": self.views,
            "seed": self.seed,
            **parts,
        }

    @cached_property
    def digest(self) -> str:
        """Name of all that the outcome depends on."""
        return name_of(self.described)


def name_of(described: Mapping[str, Any]) -> str:
    """Name a point by all that its outcome depends on, as JSON knows it."""
    return hashlib.sha256(json.dumps(described, sort_keys=True).encode()).hexdigest()[:32]


def points_of(plan: Plan) -> list[Point]:
    """Give every point of a plan with every seed, in order.

    Raises
    ------
    ArenaError, CogmapError
        For an unknown experiment or parameter, something the experiment does not take, values that cannot be,
        or two points that are the same.
    """
    check_choice("experiment", plan.experiment, tuple(sorted(experiments())))
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
    told = by_family(given)
    for family, (first, *_) in told.items():
        if family not in {"views", "arena", *FAMILIES}:
            known = ["views", "arena", "motion", "camera", "body", "nose.noise", "map.charts"]
            raise unknown(first, known)
        if family == "arena" and not chosen.any_room:
            raise CogmapError(f"{name} takes place in rooms of its own; leave {first!r} out")
        if family in FAMILIES and family not in chosen.takes:
            takes = ", ".join(("views", *(["arena"] if chosen.any_room else []), *chosen.takes))
            raise CogmapError(f"{name} does not take {first!r}; it takes {takes}")
    return {
        "views": checked_count("views", given.get("views", chosen.views), FEWEST),
        "room": _room(told.get("arena", {}), chosen.room),
        "any_room": "arena" in told,
        "overrides": {
            family: build(family, told[family], usual=chosen.body) for family in FAMILIES if family in told
        },
    }


def _room(told: dict[str, Any], usual: str) -> Arena:
    source = told.pop("arena", usual)
    if not isinstance(source, str):
        raise CogmapError(f"arena is {source!r}; give the name of a room or the path of a TOML file")
    room = Arena.load(source)
    changes = fields_of(told, Arena.model_fields)
    return room.model_copy(update=changes) if changes else room
