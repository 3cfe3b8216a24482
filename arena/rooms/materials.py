"""Materials of walls: procedural textures, and the mip maps that let the eye average them exactly.

A texture is a tile of `TILE` texels, 1 cm each, repeated along and up the wall. Each is made from its name
alone, so a material looks the same in every room, run and seed. All vary on scales from a centimetre to a
metre: an animal with blurred eyes needs the coarse ones, a feature detector the fine ones.
"""

from collections.abc import Callable
from functools import cache, lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Int, UInt8

from arena.registry import named_by_file

TEXEL = 0.01
"""Side of a texel, m."""
TILE = (1024, 128)
"""Texels along the wall and up the wall before the texture repeats."""
LEVELS = (11, 8)
"""Resolutions along the wall and up the wall, each half the one before."""

ROOMS = 4
"""Rooms whose materials are kept together, some 20 MB each."""

Texture = UInt8[np.ndarray, "along up 3"]


class MipMaps(NamedTuple):
    """The textures of a room at every pair of resolutions.

    At levels (i, j) a texel is 2^i texels long and 2^j texels high. Those of material m start at
    `texels[m, level_starts[i, j]]`: first along the wall, then up the wall, red green blue and a spare byte
    each.
    """

    texels: UInt8[np.ndarray, "materials bytes"]
    level_starts: Int[np.ndarray, "levels_along levels_up"]


@cache
def materials() -> dict[str, Callable[[np.random.Generator], np.ndarray]]:
    """Find the recipes of `arena.rooms.recipes` by their names: a generator in, colours in 0..255 out."""
    return named_by_file("arena.rooms.recipes", lambda module: getattr(module, "paint", None))


@cache
def texture(name: str) -> Texture:
    """Make the tile of a material, (1024, 128, 3) uint8: first along the wall, then from the floor up."""
    rng = np.random.default_rng(list(name.encode()))
    tile: Texture = np.clip(np.rint(materials()[name](rng)), 0, 255).astype(np.uint8)
    tile.flags.writeable = False
    return tile


@lru_cache(maxsize=ROOMS)
def mip_maps(names: tuple[str, ...]) -> MipMaps:
    """Average the named materials for the ray caster."""
    mips = [_mip_maps_of(name) for name in names]
    return MipMaps(np.stack([texels for texels, _ in mips]), mips[0][1])


@cache
def _mip_maps_of(name: str) -> tuple[UInt8[np.ndarray, "bytes"], Int[np.ndarray, "levels_along levels_up"]]:
    along = np.zeros((*TILE, 4))
    along[..., :3] = texture(name)
    blocks, sizes = [], np.empty(LEVELS, dtype=np.int64)
    for i in range(LEVELS[0]):
        coarse = along
        for j in range(LEVELS[1]):
            blocks.append(np.rint(coarse).astype(np.uint8).ravel())
            sizes[i, j] = blocks[-1].size
            coarse = 0.5 * (coarse[:, ::2] + coarse[:, 1::2])
        along = 0.5 * (along[::2] + along[1::2])
    return np.concatenate(blocks), (sizes.cumsum() - sizes.ravel()).reshape(LEVELS)


@cache
def mean_colour(name: str) -> Float32[np.ndarray, "3"]:
    """Average the colour of a material over its tile, 0..255."""
    mean: np.ndarray = texture(name).mean(axis=(0, 1))
    return mean.astype(np.float32)
