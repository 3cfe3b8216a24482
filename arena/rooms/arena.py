"""The room: what is in it, and the platform that the body may walk on."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from functools import cached_property
from importlib import resources
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pymunk
import shapely
import tomli_w
from jaxtyping import Bool, Float
from pydantic import Discriminator, Field, Tag, ValidationError, model_validator
from shapely.geometry.base import BaseGeometry
from typing_extensions import TypeAliasType

from arena.errors import ArenaError
from arena.eye.scene import Scene, scene
from arena.paths import BYTE_ORDER_MARK, user_path
from arena.rooms.light import Light
from arena.rooms.parts import Block, Box, FrozenModel, Length, Material, Pillar, Polygon, Solid, Source, Wall
from arena.rooms.schema import TidySchema
from arena.rooms.surfaces import Surfaces, surfaces
from arena.settings import AnyArray, first_error
from arena.smell.odour import OdourField

Channel = Annotated[int, Field(strict=True, ge=0, le=255)]
Colour = TypeAliasType("Colour", tuple[Channel, Channel, Channel])


def _kind_of_floor(floor: object) -> str:
    return "<material>" if isinstance(floor, str) else "<colour>"


class Arena(FrozenModel):
    """A room to explore, as in a TOML file; `load`, `parse` and `create` make one."""

    name: Annotated[str, Field(min_length=1)]
    """What to call it."""
    platform: Annotated[tuple[Polygon, ...], Field(min_length=1)]
    """Polygons (m) whose union the whole body must stay on: an invisible border."""
    walls: tuple[Wall, ...]
    """With the solids below, what can be seen and bumped into, and what odours flow around."""
    boxes: tuple[Box, ...] = ()
    """Solids with four sides."""
    pillars: tuple[Pillar, ...] = ()
    """Solids that are round."""
    blocks: tuple[Block, ...] = ()
    """Solids on any simple polygon."""
    sources: tuple[Source, ...] = ()
    """One odorant each."""
    decay_length: Length = 1.5
    """Distance in m over which an odour decays in the open, sqrt(diffusivity / decay rate)."""
    floor: Annotated[
        Annotated[Colour, Tag("<colour>")] | Annotated[Material, Tag("<material>")],
        Discriminator(_kind_of_floor),
    ] = (104, 98, 92)
    """A colour, red green blue in 0..255, or the name of a material, for a textured floor."""
    ceiling: Colour = (140, 142, 146)
    """The colour at the horizon, red green blue in 0..255."""
    zenith: Colour | None = None
    """The colour straight up, towards which the ceiling shades; without it the ceiling is plain."""
    light: Light | None = None
    """A lamp over the ambient light; without it the light is ambient only."""

    @model_validator(mode="after")
    def _sound(self) -> Arena:
        if not (self.walls or self.solids):
            raise ValueError("nothing to see: give the room at least one wall, box, pillar or block")
        x0, y0, x1, y1 = self.bounds
        for index, source in enumerate(self.sources):
            x, y = source.position
            if not (x0 <= x <= x1 and y0 <= y <= y1):
                raise ValueError(
                    f"odour source {index} at {source.position} is outside the room, whose x min, y min, "
                    f"x max, y max are {self.bounds}; move it inside"
                )
            # Nearer than a centimetre counts as inside.
            if self.obstacles.distance(shapely.Point(x, y)) < 0.01:
                raise ValueError(
                    f"odour source {index} at {source.position} is inside a wall or solid; "
                    "move it into free space"
                )
        return self

    @classmethod
    def create(cls, **fields: object) -> Arena:
        """Build an arena from Python values; like the constructor, but raises `ArenaError`."""
        try:
            return cls.model_validate(fields)
        except ValidationError as error:
            raise ArenaError(first_error(error)) from None

    @classmethod
    def parse(cls, text: str) -> Arena:
        """Read an arena from TOML text."""
        try:
            fields = tomllib.loads(text.removeprefix(BYTE_ORDER_MARK))
        except (ValueError, RecursionError) as error:
            raise ArenaError(f"this is not TOML: {error}") from None
        if not fields:
            raise ArenaError("the TOML is empty; an arena needs at least name, platform and walls")
        return cls.create(**fields)

    @classmethod
    def load(cls, source: str | Path) -> Arena:
        """Load an arena by the name of a room in the gallery or by the path of a TOML file."""
        path = user_path(source)
        if path.suffix != ".toml":
            file = resources.files("arena") / "gallery" / f"{source}.toml"
            if not file.is_file():
                raise ArenaError(
                    f"no room {str(source)!r} in the gallery; choose one of {', '.join(gallery())} "
                    "or give the path of a .toml file"
                )
            return cls.parse(file.read_text(encoding="utf-8"))
        try:
            return cls.parse(path.read_text(encoding="utf-8"))
        except ArenaError as error:
            raise ArenaError(f"{path}: {error}") from None
        except (OSError, UnicodeDecodeError) as error:
            reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8 text; save it as such"
            raise ArenaError(f"cannot read the arena {path}: {reason}") from None

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Arena:  # noqa: ARG002
        """Copy the arena with some fields changed; the copy is checked like any other."""
        return self.create(**{**self.model_dump(), **(update or {})})

    def to_toml(self) -> str:
        """Write the arena as TOML text that `parse` reads back to an equal arena."""
        return tomli_w.dumps(self.model_dump(mode="json", exclude_defaults=True))

    @cached_property
    def odours(self) -> OdourField:
        """The steady odour field around this room's walls."""
        return OdourField(
            walls=np.array([(wall.start, wall.end) for wall in self.walls]).reshape(-1, 2, 2),
            solids=[solid.outline for solid in self.solids],
            bounds=self.bounds,
            sources=np.array([source.position for source in self.sources]).reshape(-1, 2),
            decay_length=self.decay_length,
        )

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """The box around everything, (x min, y min, x max, y max) in m."""
        x0, y0, x1, y1 = shapely.union_all([self.obstacles, self.walkable]).bounds
        return float(x0), float(y0), float(x1), float(y1)

    def free_space(self, radius: float) -> BaseGeometry:
        """Where the centre of a disc of this radius (m) can be, as a shapely geometry."""
        region: BaseGeometry = self.walkable.buffer(-radius) - self.obstacles.buffer(radius)
        return region

    def is_free(self, xy: AnyArray, radius: float) -> Bool[np.ndarray, "points"]:
        """Whether a disc of this radius (m) centred at each point (m) touches nothing."""
        region = self.free_space(radius)
        shapely.prepare(region)
        free: np.ndarray = shapely.contains_xy(region, np.asarray(xy, np.float64))
        return free

    def sample_free(
        self, count: int, radius: float, rng: np.random.Generator
    ) -> Float[np.ndarray, "points 2"]:
        """Draw points uniformly from the free space of a disc of this radius (m).

        Raises
        ------
        ArenaError
            When a disc of this radius fits nowhere, or in places too far apart.
        """
        region = self.free_space(radius)
        if region.area < 1e-6:
            raise ArenaError(
                f"arena {self.name!r} has no free space for a body of radius {radius:g} m; "
                "widen the platform or remove obstacles"
            )
        shapely.prepare(region)
        low, high = np.reshape(region.bounds, (2, 2))
        # Less than a ten-thousandth of its bounds takes too long to be found by chance.
        if region.area < 1e-4 * np.prod(high - low):
            raise ArenaError(
                f"arena {self.name!r} has {region.area:.2g} m² of free space for a body of radius {radius:g} "
                f"m, scattered over {high[0] - low[0]:g} by {high[1] - low[1]:g} m; bring its parts together"
            )
        found = np.empty((0, 2))
        while len(found) < count:
            candidates = rng.uniform(low, high, (2 * count + 16, 2))
            found = np.concatenate([found, candidates[shapely.contains_xy(region, candidates)]])
        return found[:count]

    def space(self) -> pymunk.Space:
        """Build a pymunk space without gravity from the walls, solids and platform border."""
        space = pymunk.Space()
        parts = shapely.get_parts(self.walkable)
        rings = [ring for part in parts for ring in (part.exterior, *part.interiors)]
        # Thousands of solids that coincide stop a body as one does.
        outlines = {solid.outline.tobytes(): solid.outline for solid in self.solids}
        rings += [shapely.LinearRing(outline) for outline in outlines.values()]
        edges = [pair for ring in rings for pair in zip(ring.coords[:-1], ring.coords[1:], strict=True)]
        edges += [(wall.start, wall.end) for wall in self.walls]
        for a, b in edges:
            space.add(pymunk.Segment(space.static_body, a, b, 0.0))
        return space

    @cached_property
    def edges(self) -> Float[np.ndarray, "edges 2 2"]:
        """Ends (m) of all that stops a body, in the order in which Chipmunk goes through its tree of them.

        Where two are equally near, as a wall on the platform's border, the first decides the last digit.
        """
        everywhere = pymunk.BB(-math.inf, -math.inf, math.inf, math.inf)
        found = self.space().bb_query(everywhere, pymunk.ShapeFilter())
        return np.array([(edge.a, edge.b) for edge in found if isinstance(edge, pymunk.Segment)])

    @cached_property
    def surfaces(self) -> Surfaces:
        """Every vertical face, for the eye."""
        return surfaces(self.walls, self.solids, [self.floor] if isinstance(self.floor, str) else [])

    @cached_property
    def scene(self) -> Scene:
        """What there is to see, as the kernels of the eye want it."""
        return scene(self.surfaces, self.floor, self.light)

    @property
    def solids(self) -> tuple[Solid, ...]:
        """Boxes, pillars and blocks, in this order."""
        return (*self.boxes, *self.pillars, *self.blocks)

    @cached_property
    def walkable(self) -> BaseGeometry:
        """The platform, as a shapely geometry."""
        return shapely.union_all([shapely.Polygon(corners) for corners in self.platform])

    @cached_property
    def obstacles(self) -> BaseGeometry:
        """Walls and solids, as a shapely geometry."""
        walls = [shapely.LineString([wall.start, wall.end]) for wall in self.walls]
        return shapely.union_all(walls + [shapely.Polygon(solid.outline) for solid in self.solids])

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        """Describe the TOML file as JSON Schema; what only geometry can tell is checked on reading."""
        return {"$schema": TidySchema.schema_dialect, **cls.model_json_schema(schema_generator=TidySchema)}


def gallery() -> list[str]:
    """Give the names of the rooms that come with the package."""
    folder = resources.files("arena") / "gallery"
    return sorted(file.name.removesuffix(".toml") for file in folder.iterdir() if file.name.endswith(".toml"))
