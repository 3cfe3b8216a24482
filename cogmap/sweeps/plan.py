"""The plan of a sweep: what it varies, as in a TOML file."""

from __future__ import annotations

import itertools
import json
import tomllib
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
import tomli_w
from pydantic import Field, ValidationError

from arena.paths import BYTE_ORDER_MARK
from arena.rooms.parts import FrozenModel
from arena.settings import first_error
from cogmap.atomic import user_path
from cogmap.errors import CogmapError
from cogmap.sweeps.sampling import Sample

Shown = float | int | str


class Choice(NamedTuple):
    """One value of a parameter."""

    shown: Shown
    """How the table tells it from others."""
    value: Any


class Plan(FrozenModel):
    """An experiment, and at which points and seeds it is done; `load`, `parse` and `create` make one.

    Exactly one of `grid`, `points` and `sample` says what is varied. Parameters are `views`, `arena` (a room
    of the gallery or a TOML file), `motion` and `camera` (by name), and `arena.KEY`, `motion.KEY`,
    `camera.KEY`, `nose.KEY` and `map.KEY` for one field of a room, a motion, a camera, the nose or the map.
    A motion or camera of which only fields are given is brownian or panoramic.
    """

    experiment: str
    """Its name."""
    views: Annotated[int, Field(strict=True)] | None = None
    """To learn from at every point; the experiment's own number when None."""
    seeds: Annotated[tuple[Annotated[int, Field(strict=True, ge=0)], ...], Field(min_length=1)] = (0,)
    """Each point is repeated with every one."""
    fixed: Annotated[dict[str, Any], Field(alias="set", default_factory=dict)]
    """Parameters that are the same at every point, as `set` in the file."""
    grid: dict[str, list[Any] | dict[str, Any]] | None = None
    """Values by parameter, of which every combination is a point; as a table, each value has a name."""
    points: list[dict[str, Any]] | None = None
    """The points one by one, each a value by parameter."""
    sample: Sample | None = None
    """Points to be drawn from ranges."""
    labels: dict[str, str] = Field(default_factory=dict)
    """What figures call a parameter or a statistic."""

    @classmethod
    def create(cls, **fields: object) -> Plan:
        """Build a plan from Python values; like the constructor, but raises `CogmapError`."""
        try:
            plan = cls.model_validate(fields)
        except ValidationError as error:
            raise CogmapError(f"the sweep's {first_error(error)}") from None
        plan.check()
        return plan

    @classmethod
    def parse(cls, text: str) -> Plan:
        """Read a plan from TOML text."""
        try:
            fields = tomllib.loads(text.removeprefix(BYTE_ORDER_MARK))
        except (ValueError, RecursionError) as error:
            raise CogmapError(f"this is not TOML: {error}") from None
        if not fields:
            raise CogmapError("the TOML is empty; a sweep needs at least experiment and grid")
        return cls.create(**fields)

    @classmethod
    def load(cls, path: str | Path) -> Plan:
        """Read a plan from a TOML file."""
        path = user_path(path)
        try:
            return cls.parse(path.read_text(encoding="utf-8"))
        except CogmapError as error:
            raise CogmapError(f"{path}: {error}") from None
        except (OSError, UnicodeDecodeError) as error:
            reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8 text; save it as such"
            raise CogmapError(f"cannot read the sweep {path}: {reason}") from None

    def to_toml(self) -> str:
        """Write the plan as TOML text, which `parse` reads back."""
        return tomli_w.dumps(self.model_dump(mode="json", by_alias=True, exclude_defaults=True))

    @property
    def varied(self) -> tuple[str, ...]:
        """The parameters that differ from point to point."""
        if self.sample is not None:
            return tuple(self.sample.ranges)
        return tuple(self.grid if self.grid is not None else (self.points or [{}])[0])

    @property
    def logarithmic(self) -> frozenset[str]:
        """The parameters drawn on a log scale, and those of a grid with three or more at equal ratios."""
        if self.sample is not None:
            return frozenset(name for name, span in self.sample.ranges.items() if span.log)
        grid = self.grid or {}
        return frozenset(name for name, values in grid.items() if _is_geometric(_choices(values)))

    def assignments(self) -> list[dict[str, Choice]]:
        """Give the points in order, each a choice by parameter that varies."""
        if self.grid is not None:
            axes = [_choices(values) for values in self.grid.values()]
            return [dict(zip(self.grid, point, strict=True)) for point in itertools.product(*axes)]
        points = self.points or [] if self.sample is None else self.sample.draw()
        return [{name: Choice(_shown(value), value) for name, value in point.items()} for point in points]

    def check(self) -> None:
        """Raise unless something is varied, in one way, and nothing is said twice."""
        if (self.grid is not None) + (self.points is not None) + (self.sample is not None) != 1:
            raise CogmapError("a sweep varies something in exactly one way; give a grid, points or a sample")
        if not self.varied:
            raise CogmapError("the sweep has no points; give at least one parameter with values")
        for name, values in (self.grid or {}).items():
            if not values:
                raise CogmapError(f"the grid is empty: it has no values for {name!r}; give at least one")
        for index, point in enumerate(self.points or []):
            if point.keys() != set(self.varied):
                raise CogmapError(
                    f"point {index} has {_listed(point)} and the first has {_listed(self.varied)}; "
                    "give every point the same parameters"
                )
        twice = {*self.varied} & {*self.fixed, *(["views"] if self.views is not None else [])}
        if twice:
            raise CogmapError(f"{_listed(sorted(twice))} is both fixed and varied; say one of them")
        if len(set(self.seeds)) < len(self.seeds):
            raise CogmapError(f"the seeds {list(self.seeds)} repeat themselves; give each once")


def _choices(values: list[Any] | dict[str, Any]) -> list[Choice]:
    """Values by their names, which are numbers where all are."""
    if isinstance(values, list):
        return [Choice(_shown(value), value) for value in values]
    names: list[Shown] = list(values)
    with suppress(ValueError):
        names = [float(name) if set(str(name)) & set(".eE") else int(name) for name in names]
    return [Choice(name, value) for name, value in zip(names, values.values(), strict=True)]


def _shown(value: object) -> Shown:
    if isinstance(value, str) or (isinstance(value, int | float) and not isinstance(value, bool)):
        return value
    return json.dumps(value, separators=(",", ":"), default=str)


def _is_geometric(choices: list[Choice]) -> bool:
    numbers = [choice.shown for choice in choices if not isinstance(choice.shown, str)]
    if len(numbers) < max(3, len(choices)) or min(numbers) <= 0:
        return False
    steps = np.diff(np.log(np.sort(numbers)))
    return bool(steps.min() > 0 and steps.max() < 1.1 * steps.min())


def _listed(names: Iterable[str]) -> str:
    return ", ".join(map(repr, names)) or "nothing"
