"""The room: walls, boxes, pillars, odour sources, and the platform that the body may walk on."""

from __future__ import annotations

import tomllib
from functools import cached_property
from importlib import resources
from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
import pymunk
import shapely
import tomli_w
from jaxtyping import Bool, Float, Int
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, model_validator
from shapely.geometry.base import BaseGeometry

from arena.errors import ArenaError
from arena.materials import MATERIALS
from arena.odour import OdourField
from arena.settings import complaint

Coordinate = Annotated[float, Field(allow_inf_nan=False, ge=-1e3, le=1e3)]
Point = tuple[Coordinate, Coordinate]
Length = Annotated[float, Field(allow_inf_nan=False, gt=0, le=1e3)]
Polygon = Annotated[tuple[Point, ...], Field(min_length=3)]

PILLAR_SIDES = 32
"""A pillar is a regular prism, the same one for the eye, the body and the odour."""
CLEARANCE = 0.01
"""An odour source nearer than this (m) to a wall counts as inside it."""


def _known_material(name: str) -> str:
    if name not in MATERIALS:
        raise ValueError(f"unknown material {name!r}; known are {', '.join(sorted(MATERIALS))}")
    return name


Material = Annotated[str, AfterValidator(_known_material)]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Wall(_Part):
    """A thin vertical wall from `start` to `end` (m), seen from both sides, `height` m high."""

    start: Point
    end: Point
    height: Length = 1.0
    material: Material

    @model_validator(mode="after")
    def _has_length(self) -> Wall:
        if np.hypot(self.end[0] - self.start[0], self.end[1] - self.start[1]) < 1e-6:
            raise ValueError(f"a wall of zero length at {self.start}; give it two different ends")
        return self


class Box(_Part):
    """A solid box: `center` and `size` (width, depth) in m, turned by `angle_deg`, `height` m high."""

    center: Point
    size: tuple[Length, Length]
    angle_deg: Annotated[float, Field(allow_inf_nan=False)] = 0.0
    height: Length = 0.6
    material: Material

    @property
    def outline(self) -> Float[np.ndarray, "corners 2"]:
        """The corners in m, counter-clockwise."""
        angle = np.deg2rad(self.angle_deg)
        corners = 0.5 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * self.size
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        outline: np.ndarray = corners @ turn + self.center
        return outline


class Pillar(_Part):
    """A solid round pillar: `center` and `radius` in m, `height` m high."""

    center: Point
    radius: Length
    height: Length = 1.0
    material: Material

    @property
    def outline(self) -> Float[np.ndarray, "corners 2"]:
        """The corners of the prism in m, counter-clockwise."""
        angle = np.arange(PILLAR_SIDES) * (2 * np.pi / PILLAR_SIDES)
        return self.radius * np.stack([np.cos(angle), np.sin(angle)], axis=1) + self.center


class Source(_Part):
    """A point source of one odour at `position` (m)."""

    position: Point


class Surfaces(NamedTuple):
    """Every vertical face of the room, boxes and pillars counter-clockwise seen from above."""

    start: Float[np.ndarray, "faces 2"]
    end: Float[np.ndarray, "faces 2"]
    height: Float[np.ndarray, "faces"]
    material: Int[np.ndarray, "faces"]
    """Index into `materials`."""
    offset: Float[np.ndarray, "faces"]
    """Where along its material (m) the face starts: the faces of a box share one wrapping."""
    closed: Bool[np.ndarray, "faces"]
    """Whether the face bounds a solid, so that its back is never seen."""
    materials: tuple[str, ...]
    """The names of the materials in use, sorted."""


class Arena(_Part):
    """A room to explore, as in a TOML file; see `arena/gallery` for examples.

    Parameters
    ----------
    name
        What to call it.
    platform
        Polygons (m) whose union the whole body must stay on: an invisible border.
    walls, boxes, pillars
        What can be seen, bumped into, and what odours must flow around.
    sources
        One odorant each.
    decay_length
        Distance in m over which an odour decays in the open, sqrt(diffusivity / decay rate).
    floor, ceiling
        Colours, red green blue in 0..255.

    Raises
    ------
    ArenaError
        From `load`, `parse` and `create` for anything malformed, in one sentence.
    """

    name: Annotated[str, Field(min_length=1)]
    platform: Annotated[tuple[Polygon, ...], Field(min_length=1)]
    walls: tuple[Wall, ...]
    boxes: tuple[Box, ...] = ()
    pillars: tuple[Pillar, ...] = ()
    sources: tuple[Source, ...] = ()
    decay_length: Length = 1.5
    floor: tuple[Annotated[int, Field(ge=0, le=255)], ...] = Field((104, 98, 92), min_length=3, max_length=3)
    ceiling: tuple[Annotated[int, Field(ge=0, le=255)], ...] = Field(
        (140, 142, 146), min_length=3, max_length=3
    )

    @model_validator(mode="after")
    def _sound(self) -> Arena:
        for index, corners in enumerate(self.platform):
            if not shapely.Polygon(corners).is_valid:
                raise ValueError(f"platform {index} crosses itself; list its corners in order")
        if not (self.walls or self.boxes or self.pillars):
            raise ValueError("nothing to see: give the room at least one wall, box or pillar")
        for index, source in enumerate(self.sources):
            point = shapely.Point(source.position)
            if self._obstacles.distance(point) < CLEARANCE:
                raise ValueError(
                    f"odour source {index} at {source.position} is inside a wall; move it into free space"
                )
        return self

    @classmethod
    def create(cls, **fields: object) -> Arena:
        """Build an arena from Python values; like the constructor, but raises `ArenaError`."""
        try:
            return cls.model_validate(fields)
        except ValidationError as error:
            raise ArenaError(complaint(error)) from None

    @classmethod
    def parse(cls, text: str) -> Arena:
        """Read an arena from TOML text."""
        try:
            fields = tomllib.loads(text)
        except (ValueError, RecursionError) as error:
            raise ArenaError(f"this is not TOML: {error}") from None
        if not fields:
            raise ArenaError("the TOML is empty; an arena needs at least name, platform and walls")
        return cls.create(**fields)

    @classmethod
    def load(cls, source: str | Path) -> Arena:
        """Load an arena by the name of a room in the gallery or by the path of a TOML file."""
        path = Path(source)
        if path.suffix != ".toml":
            file = resources.files("arena") / "gallery" / f"{source}.toml"
            if not file.is_file():
                raise ArenaError(
                    f"no room {str(source)!r} in the gallery; choose one of {', '.join(gallery())} "
                    "or give the path of a .toml file"
                )
            return cls.parse(file.read_text(encoding="utf-8"))
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8 text"
            raise ArenaError(f"cannot read the arena {path}: {reason}") from None
        try:
            return cls.parse(text)
        except ArenaError as error:
            raise ArenaError(f"{path}: {error}") from None

    def to_toml(self) -> str:
        """Write the arena as TOML text that `parse` reads back to an equal arena."""
        return tomli_w.dumps(self.model_dump(mode="json", exclude_defaults=True))

    @cached_property
    def odours(self) -> OdourField:
        """The steady odour field around this room's walls."""
        return OdourField(
            walls=np.array([(wall.start, wall.end) for wall in self.walls]).reshape(-1, 2, 2),
            solids=[solid.outline for solid in self._solids],
            bounds=self.bounds,
            sources=np.array([source.position for source in self.sources]).reshape(-1, 2),
            decay_length=self.decay_length,
        )

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """The box around everything, (x min, y min, x max, y max) in m."""
        x0, y0, x1, y1 = shapely.union_all([self._obstacles, self._walkable]).bounds
        return float(x0), float(y0), float(x1), float(y1)

    def free_space(self, radius: float) -> BaseGeometry:
        """Where the centre of a disc of this radius (m) can be, as a shapely geometry."""
        region: BaseGeometry = self._walkable.buffer(-radius) - self._obstacles.buffer(radius)
        return region

    def is_free(self, xy: Float[np.ndarray, "points 2"], radius: float) -> Bool[np.ndarray, "points"]:
        """Whether a disc of this radius (m) centred at each point (m) touches nothing."""
        region = self.free_space(radius)
        shapely.prepare(region)
        free: np.ndarray = shapely.contains_xy(region, xy)
        return free

    def sample_free(
        self, count: int, radius: float, rng: np.random.Generator
    ) -> Float[np.ndarray, "points 2"]:
        """Draw points uniformly from the free space of a disc of this radius (m).

        Raises
        ------
        ArenaError
            When a disc of this radius fits nowhere.
        """
        region = self.free_space(radius)
        if region.area < 1e-6:
            raise ArenaError(
                f"arena {self.name!r} has no free space for a body of radius {radius:g} m; "
                "widen the platform or remove obstacles"
            )
        shapely.prepare(region)
        low, high = np.reshape(region.bounds, (2, 2))
        found = np.empty((0, 2))
        while len(found) < count:
            candidates = rng.uniform(low, high, (2 * count + 16, 2))
            found = np.concatenate([found, candidates[shapely.contains_xy(region, candidates)]])
        return found[:count]

    def space(self) -> pymunk.Space:
        """Build a pymunk space without gravity from the walls, solids and platform border."""
        space = pymunk.Space()
        border = self._walkable
        rings = [ring for part in shapely.get_parts(border) for ring in (part.exterior, *part.interiors)]
        rings += [shapely.LinearRing(solid.outline) for solid in self._solids]
        edges = [pair for ring in rings for pair in zip(ring.coords[:-1], ring.coords[1:], strict=True)]
        edges += [(wall.start, wall.end) for wall in self.walls]
        for a, b in edges:
            space.add(pymunk.Segment(space.static_body, a, b, 0.0))
        return space

    @cached_property
    def surfaces(self) -> Surfaces:
        """Every vertical face, for the eye."""
        outlines: list[tuple[np.ndarray, Wall | Box | Pillar, bool]] = [
            (np.array([wall.start, wall.end]), wall, False) for wall in self.walls
        ]
        outlines += [(np.vstack([solid.outline, solid.outline[:1]]), solid, True) for solid in self._solids]
        names = tuple(sorted({part.material for _, part, _ in outlines}))
        faces = [len(corners) - 1 for corners, _, _ in outlines]
        lengths = [np.hypot(*np.diff(corners, axis=0).T) for corners, _, _ in outlines]
        return Surfaces(
            start=np.concatenate([corners[:-1] for corners, _, _ in outlines]),
            end=np.concatenate([corners[1:] for corners, _, _ in outlines]),
            height=np.repeat([part.height for _, part, _ in outlines], faces),
            material=np.repeat([names.index(part.material) for _, part, _ in outlines], faces),
            offset=np.concatenate([np.cumsum(length) - length for length in lengths]),
            closed=np.repeat([closed for _, _, closed in outlines], faces),
            materials=names,
        )

    @property
    def _solids(self) -> tuple[Box | Pillar, ...]:
        return (*self.boxes, *self.pillars)

    @cached_property
    def _walkable(self) -> BaseGeometry:
        return shapely.union_all([shapely.Polygon(corners) for corners in self.platform])

    @cached_property
    def _obstacles(self) -> BaseGeometry:
        walls = [shapely.LineString([wall.start, wall.end]) for wall in self.walls]
        return shapely.union_all(walls + [shapely.Polygon(solid.outline) for solid in self._solids])


def gallery() -> list[str]:
    """Give the names of the rooms that come with the package."""
    folder = resources.files("arena") / "gallery"
    return sorted(file.name.removesuffix(".toml") for file in folder.iterdir() if file.name.endswith(".toml"))
