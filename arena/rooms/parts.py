"""Parts of a room: walls, boxes, pillars, blocks and odour sources."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
import shapely
from jaxtyping import Float
from pydantic import AfterValidator, BaseModel, ConfigDict, Discriminator, Field, Tag, model_validator
from typing_extensions import TypeAliasType

from arena.rooms.materials import materials
from arena.settings import plain

PILLAR_SIDES = 32
"""A pillar is a regular prism, the same one for the eye, the body and the odour."""
SHORTEST = 1e-6
"""Sides shorter than this (m) have no direction."""

Coordinate = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-1e3, le=1e3)]
Length = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=1e-3, le=1e3)]
Angle = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-360, le=360)]
Point = TypeAliasType("Point", tuple[Coordinate, Coordinate])


def _known(name: str) -> str:
    if name not in materials():
        raise ValueError(f"unknown material; choose one of {', '.join(materials())}")
    return name


def _simple(corners: tuple[Point, ...]) -> tuple[Point, ...]:
    if len(corners) > 3 and corners[0] == corners[-1]:  # closed, as many programs write outlines
        corners = corners[:-1]
    sides = np.hypot(*(np.roll(corners, -1, axis=0) - corners).T)
    if sides.min() < SHORTEST:
        corner = int(sides.argmin())
        raise ValueError(f"corner {corner} and the next are the same point; list each corner once")
    if not shapely.Polygon(corners).is_valid:
        raise ValueError("the polygon crosses itself or is flat; list its corners in order")
    return corners


Polygon = Annotated[tuple[Point, ...], Field(min_length=3), AfterValidator(_simple)]
"""Corners (m) in either order around; the first may be repeated at the end."""
_Named = Field(json_schema_extra=lambda schema: schema.update(enum=list(materials())))
Material = TypeAliasType("Material", Annotated[str, AfterValidator(_known), _Named])
"""The name of a recipe in `arena.rooms.recipes`."""


def _number_of_names(material: object) -> str:
    return "<one>" if isinstance(material, str) else "<each>"


class FrozenModel(BaseModel):
    """A frozen value that knows no other fields than its own."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    @model_validator(mode="before")
    @classmethod
    def _of_plain_numbers(cls, fields: object) -> object:
        return plain(fields)


class Wall(FrozenModel):
    """A thin vertical wall, seen from both sides."""

    start: Point
    """One end, m."""
    end: Point
    """The other end, m."""
    height: Length = 1.0
    """Above the floor, m."""
    material: Material
    """Of both sides."""

    @model_validator(mode="after")
    def _has_length(self) -> Wall:
        if np.hypot(self.end[0] - self.start[0], self.end[1] - self.start[1]) < SHORTEST:
            raise ValueError(f"a wall of zero length at {self.start}; give it two different ends")
        return self


class Box(FrozenModel):
    """A solid box."""

    center: Point
    """Its middle, m."""
    size: tuple[Length, Length]
    """Width and depth, m."""
    angle_deg: Angle = 0.0
    """How far it is turned counter-clockwise."""
    height: Length = 0.6
    """Above the floor, m."""
    material: Annotated[
        Annotated[Material, Tag("<one>")]
        | Annotated[tuple[Material, Material, Material, Material], Tag("<each>")],
        Discriminator(_number_of_names),
    ]
    """One name, or those of the front (−y), right (+x), back and left of the box before it is turned."""

    @property
    def outline(self) -> Float[np.ndarray, "corners 2"]:
        """The corners in m, counter-clockwise; the front lies between the first two."""
        angle = math.radians(self.angle_deg)
        x, y = (0.5 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * self.size).T
        # spelt out: a matrix product is rounded as the processor likes, and every pixel would hang on it
        cos, sin = math.cos(angle), math.sin(angle)
        return np.stack([x * cos - y * sin, x * sin + y * cos], axis=1) + self.center

    @property
    def sides(self) -> tuple[str, ...]:
        """The material of each side of the outline."""
        return (self.material,) * 4 if isinstance(self.material, str) else self.material


class Pillar(FrozenModel):
    """A solid round pillar."""

    center: Point
    """Its middle, m."""
    radius: Length
    """Of its corners, m."""
    height: Length = 1.0
    """Above the floor, m."""
    material: Material
    """All around."""

    @property
    def outline(self) -> Float[np.ndarray, "corners 2"]:
        """The corners of the prism in m, counter-clockwise."""
        angle = np.arange(PILLAR_SIDES) * (2 * np.pi / PILLAR_SIDES)
        return self.radius * np.stack([np.cos(angle), np.sin(angle)], axis=1) + self.center

    @property
    def sides(self) -> tuple[str, ...]:
        """The material of each side of the outline."""
        return (self.material,) * PILLAR_SIDES


class Block(FrozenModel):
    """A solid prism on any simple polygon, which need not be convex."""

    corners: Polygon
    """In either order around, m; the first may be repeated at the end."""
    height: Length = 0.6
    """Above the floor, m."""
    material: Annotated[
        Annotated[Material, Tag("<one>")]
        | Annotated[tuple[Material, ...], Field(min_length=3), Tag("<each>")],
        Discriminator(_number_of_names),
    ]
    """One name, or one per side, the first for the side from the first corner to the second."""

    @model_validator(mode="after")
    def _all_sides_are_of_something(self) -> Block:
        if len(self.sides) != len(self.corners):
            raise ValueError(
                f"{len(self.sides)} materials for {len(self.corners)} sides; give one name or one per side"
            )
        return self

    @property
    def outline(self) -> Float[np.ndarray, "corners 2"]:
        """The corners in m, counter-clockwise from the first."""
        corners = np.array(self.corners)
        return np.roll(corners[::-1], 1, axis=0) if self._clockwise else corners

    @property
    def sides(self) -> tuple[str, ...]:
        """The material of each side of the outline."""
        if isinstance(self.material, str):
            return (self.material,) * len(self.corners)
        return self.material[::-1] if self._clockwise else self.material

    @property
    def _clockwise(self) -> bool:
        return not shapely.LinearRing(self.corners).is_ccw


Solid = Box | Pillar | Block


class Source(FrozenModel):
    """A point source of one odour."""

    position: Point
    """In free space, m."""
