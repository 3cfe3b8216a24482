"""The scene: a room as the eye's kernels want it, in tables of numbers."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int, Shaped, UInt8

from arena.eye.projection import FACE
from arena.eye.texture_sampling import BLOCK, Ground
from arena.rooms.light import Light
from arena.rooms.materials import ROOMS, mean_colour, mip_maps
from arena.rooms.surfaces import Surfaces


class Scene(NamedTuple):
    """What there is to see in a room, under its light."""

    faces: Shaped[np.ndarray, " faces"]
    """Of dtype `arena.eye.projection.FACE`."""
    floor: Ground
    texels: UInt8[np.ndarray, " bytes"]
    """Those of `arena.rooms.materials.MipMaps`, end to end."""
    level_starts: Int[np.ndarray, "levels_along levels_up"]
    tallest: float
    """Height of the tallest face, m."""


@lru_cache(maxsize=ROOMS)
def _texels(names: tuple[str, ...]) -> UInt8[np.ndarray, " bytes"]:
    return np.pad(mip_maps(names).texels.ravel(), (0, BLOCK))


def scene(surfaces: Surfaces, floor: str | tuple[int, int, int], light: Light | None) -> Scene:
    """Lay out a room for the kernels; `floor` is the name of a material or a colour."""
    names = surfaces.materials
    mips = mip_maps(names)
    begins = mips.texels.shape[1] * np.arange(len(names))
    faces = np.zeros(len(surfaces.height), FACE)
    faces["x0"], faces["y0"] = surfaces.start.T
    faces["x1"], faces["y1"] = surfaces.end.T
    faces["height"], faces["offset"] = surfaces.height, surfaces.offset
    faces["closed"], faces["solid"] = surfaces.closed, surfaces.solid
    faces["start"] = begins[surfaces.material]
    along = surfaces.end - surfaces.start
    right = np.column_stack([along[:, 1], -along[:, 0], np.zeros(len(along))])
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    faces["left_light"], faces["right_light"] = _brightness(light, -right), _brightness(light, right)
    above = float(_brightness(light, np.array([[0.0, 0.0, 1.0]]))[0])
    top_colours = np.stack([mean_colour(name) for name in names])[surfaces.material]
    for solid in range(surfaces.solid.max() + 1):
        top_colours[surfaces.solid == solid] = top_colours[surfaces.solid == solid].mean(axis=0)
    faces["red"], faces["green"], faces["blue"] = above * top_colours.T
    if isinstance(floor, str):
        red, green, blue = (above * mean_colour(floor)).tolist()
        start = int(begins[names.index(floor)])
    else:
        red, green, blue = (above * channel for channel in floor)
        start = -1
    return Scene(
        faces,
        Ground(red, green, blue, start, above),
        _texels(names),
        mips.level_starts,
        surfaces.height.max(),
    )


def _brightness(light: Light | None, normals: Float[np.ndarray, "faces 3"]) -> Float[np.ndarray, " faces"]:
    return np.ones(len(normals)) if light is None else light.brightness(normals)
