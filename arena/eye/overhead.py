"""The overhead camera: it hangs still over the room and sees the body move in it."""

import math
from functools import lru_cache
from typing import Annotated

import numpy as np
import shapely
from jaxtyping import Float
from pydantic import Field

from arena.bodies.base import Body, Configurations
from arena.errors import ArenaError
from arena.eye.camera import Images
from arena.eye.capsules import paint
from arena.eye.noise import Generators, add_noise
from arena.rooms.arena import Arena
from arena.rooms.materials import TEXEL, materials, texture
from arena.rooms.parts import Solid, Wall
from arena.settings import Positive, Settings

WALL = 0.06
"""How thick walls are drawn, m."""
FINE = 512
"""The plan is drawn at about so many rows, of which each of the picture is the mean."""
STRIP = 500
"""Length of the texture along a link, texels."""

_Pixels = Annotated[int, Field(gt=0, le=4096)]


class Overhead(Settings):
    """A camera that looks straight down from far above: parallel rays, x to the right and y up.

    It sees the floor, walls and solids, of the material of their first side on top, and over them the body:
    each link a strip of a material of its own with round ends, later ones on top, and a red dot where the
    body's own eye is, towards where that looks. A pixel's share of a link is taken from the distance of its
    middle from the link's axis, so that the image changes smoothly as the body moves.

    Parameters
    ----------
    width, height
        Pixels, which are square.
    center
        Of the picture, m.
    span
        What of the room the width shows, m.
    links
        Materials of the links, in turn.
    noise
        Standard deviation of the sensor's independent Gaussian noise, as a share of the brightest grey level.

    Raises
    ------
    ArenaError
        For parameters out of range, and materials that there are not.
    """

    width: _Pixels = 64
    height: _Pixels = 64
    center: tuple[float, float] = (0.0, 0.0)
    span: Positive = 4.0
    links: Annotated[tuple[str, ...], Field(min_length=1)] = ("blue", "white")
    noise: Annotated[float, Field(ge=0, le=1)] = 0.0

    def __init__(self, width: int = 64, height: int = 64, **fields: object) -> None:
        super().__init__(width=width, height=height, **fields)
        unknown = sorted(set(self.links) - materials().keys())
        if unknown:
            raise ArenaError(f"there is no material {unknown[0]!r}; choose among {', '.join(materials())}")

    def look(
        self,
        arena: Arena,
        body: Body,
        configurations: Configurations,
        *,
        rng: Generators | None = None,
    ) -> Images:
        """Paint the room and the body in each configuration.

        Parameters
        ----------
        rng
            Where the sensor noise comes from, or one generator for each view; needed only with `noise`.

        Raises
        ------
        ArenaError
            For noise without a generator.
        """
        pixel = self.span / self.width
        # Of the middle of the pixel at the top left.
        x, y = self.center
        corner = x + 0.5 * (1 - self.width) * pixel, y + 0.5 * (self.height - 1) * pixel
        segments, poses = body.segments(configurations), body.camera_poses(configurations)
        # One by one: numpy's own cosine has another last digit on another processor.
        ahead = 0.5 * body.radius * np.array([(math.cos(h), math.sin(h)) for h in poses[:, 2].tolist()])
        dots = np.repeat((poses[:, :2] + ahead)[:, None], 2, axis=1)
        count = segments.shape[1]
        strips = np.stack([*(_strip(self.links[k % len(self.links)], pixel) for k in range(count)), _DOT])
        radii = np.array([body.radius] * count + [0.4 * body.radius])
        capsules = np.concatenate([segments, dots[:, None]], axis=1)
        plan = _plan(self, arena.walls, arena.solids, arena.floor)
        out = np.empty((len(configurations), self.height, self.width, 3), np.uint8)
        paint((capsules - corner) / pixel, radii / pixel, strips, TEXEL / pixel, plan, out)
        add_noise(out, self.noise, rng)
        return out


_DOT = np.tile([214.0, 69.0, 65.0], (STRIP, 1))


@lru_cache(maxsize=32)
def _strip(material: str, pixel: float) -> Float[np.ndarray, "texels 3"]:
    """Average a material across a link and over the length of a pixel (m) along it, for each texel."""
    line = texture(material).mean(axis=1)
    wide = max(1, round(pixel / TEXEL))
    mean: np.ndarray = np.stack([np.roll(line, k, axis=0) for k in range(wide)]).mean(axis=0)[:STRIP]
    return mean


@lru_cache(maxsize=8)
def _plan(
    eye: Overhead, walls: tuple[Wall, ...], solids: tuple[Solid, ...], floor: str | tuple[int, int, int]
) -> Float[np.ndarray, "height width 3"]:
    """Paint what does not move."""
    fine = max(2, -(-FINE // eye.height))
    pixel = eye.span / eye.width / fine
    x = eye.center[0] + (np.arange(eye.width * fine) + 0.5 - eye.width * fine / 2) * pixel
    y = eye.center[1] - (np.arange(eye.height * fine) + 0.5 - eye.height * fine / 2) * pixel
    plan = np.empty((len(y), len(x), 3), np.float32)
    i, j = np.floor(x / TEXEL).astype(int)[None], np.floor(y / TEXEL).astype(int)[:, None]

    def laid(material: str) -> np.ndarray:
        tile = texture(material)
        texels: np.ndarray = tile[i % tile.shape[0], j % tile.shape[1]]
        return texels

    plan[:] = laid(floor) if isinstance(floor, str) else floor
    tops = [(shapely.Polygon(solid.outline), solid.sides[0]) for solid in solids]
    rims = [
        (shapely.LineString([wall.start, wall.end]).buffer(WALL / 2, cap_style="square"), wall.material)
        for wall in walls
    ]
    for shape, material in [*tops, *rims]:
        shapely.prepare(shape)
        inside = shapely.contains_xy(shape, x[None], y[:, None])
        plan[inside] = laid(material)[inside]
    blocks = plan.reshape(eye.height, fine, eye.width, fine, 3)
    mean: np.ndarray = blocks.mean(axis=(1, 3), dtype=np.float64)
    return mean
