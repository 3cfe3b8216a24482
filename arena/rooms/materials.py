"""Materials of walls: procedural textures, and the mip maps that let the eye average them exactly.

A texture is a tile of `TILE` texels, 1 cm each, repeated along and up the wall. Each is made from its name
alone, so a material looks the same in every room, run and seed. All vary on scales from a centimetre to a
metre: an animal with blurred eyes needs the coarse ones, a feature detector the fine ones.
"""

from collections.abc import Callable
from functools import cache, lru_cache
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Float32, Int, UInt8

TEXEL = 0.01
"""Side of a texel, m."""
TILE = (1024, 128)
"""Texels along the wall and up the wall before the texture repeats."""
LEVELS = (11, 8)
"""Resolutions along the wall and up the wall, each half the one before."""

ROOMS = 4
"""Rooms whose materials are kept together, some 20 MB each."""

Texture = UInt8[np.ndarray, "along up 3"]
_Tint = tuple[int, int, int]


class MipMaps(NamedTuple):
    """The textures of a room at every pair of resolutions.

    At levels (i, j) a texel is 2^i texels long and 2^j texels high. Those of material m start at
    `texels[m, level_starts[i, j]]`: first along the wall, then up the wall, red green blue and a spare byte
    each.
    """

    texels: UInt8[np.ndarray, "materials bytes"]
    level_starts: Int[np.ndarray, "levels_along levels_up"]


def _cloud(rng: np.random.Generator, along: float, up: float) -> Float[np.ndarray, "along up"]:
    """Smooth periodic noise of unit variance with correlation lengths `along` and `up` (m)."""
    white = np.fft.rfft2(rng.standard_normal(TILE))
    kx, ky = np.fft.fftfreq(TILE[0], TEXEL)[:, None], np.fft.rfftfreq(TILE[1], TEXEL)[None]
    blur = np.exp(-2 * (np.pi * along * kx) ** 2 - 2 * (np.pi * up * ky) ** 2)
    field: np.ndarray = np.fft.irfft2(white * blur, TILE)
    field -= field.mean()
    field /= field.std()
    return field


def _strips(rng: np.random.Generator, count: int, narrow: float, wide: float) -> Int[np.ndarray, "count"]:
    """Label `count` texels by strips of random widths between `narrow` and `wide` (m)."""
    edges = np.cumsum(rng.uniform(narrow, wide, int(count * TEXEL / narrow) + 2)) / TEXEL
    return np.searchsorted(edges, np.arange(count), side="right")


def _palette(rng: np.random.Generator, colours: list[_Tint], count: int, spread: float) -> np.ndarray:
    picked: np.ndarray = np.array(colours, float)[rng.integers(len(colours), size=count)]
    picked *= np.exp(spread * rng.standard_normal((count, 1)))
    return picked


def _stained(
    rng: np.random.Generator, colour: np.ndarray, stain: _Tint, depth: float, scale: float = 0.3
) -> np.ndarray:
    """Blend a coarse stain of correlation length `scale` (m) into a coloured tile."""
    amount = depth / (1 + np.exp(-2 * _cloud(rng, scale, scale)))
    stained: np.ndarray = colour + amount[..., None] * (np.array(stain) - colour)
    return stained


def _bricks(
    rng: np.random.Generator, size: tuple[float, float], colours: list[_Tint], joint: _Tint, spread: float
) -> np.ndarray:
    """Courses of bricks of `size` (m), every second one shifted by half a brick, with joints of 1 cm."""
    u, v = np.arange(TILE[0])[:, None], np.arange(TILE[1])[None]
    length, rise = (round(side / TEXEL) for side in size)
    course = v // rise
    shifted = u + (course % 2) * (length // 2)
    brick = shifted // length
    columns = TILE[0] // length + 2
    colour = _palette(rng, colours, columns * (TILE[1] // rise + 1), spread)[course * columns + brick]
    seam = (shifted % length == 0) | (v % rise == 0)
    return np.where(seam[..., None], np.array(joint), colour)


def _brick(rng: np.random.Generator) -> np.ndarray:
    bricks = _bricks(rng, (0.24, 0.08), [(168, 74, 52), (142, 58, 44), (190, 104, 70)], (196, 186, 170), 0.12)
    return _stained(rng, bricks, (70, 44, 40), 0.7)


def _timber(rng: np.random.Generator) -> np.ndarray:
    plank = _strips(rng, TILE[0], 0.12, 0.35)
    colour = _palette(rng, [(196, 152, 92), (150, 104, 58), (224, 190, 130), (112, 78, 50)], TILE[0], 0.1)[
        plank
    ]
    grain = 1 + 0.1 * _cloud(rng, 0.01, 0.2)
    seam = np.r_[True, np.diff(plank) > 0][:, None, None]
    return _stained(rng, np.where(seam, 40.0, colour[:, None] * grain[..., None]), (88, 60, 40), 0.4)


def _tiles(rng: np.random.Generator) -> np.ndarray:
    colours: list[_Tint] = [(64, 128, 150), (214, 220, 206), (40, 84, 112), (120, 176, 164)]
    tiles = _bricks(rng, (0.16, 0.16), colours, (230, 230, 224), 0.08)
    return _stained(rng, tiles, (30, 74, 96), 0.6, 0.4)


def _stone(rng: np.random.Generator, base: _Tint, tint: tuple[float, float, float]) -> np.ndarray:
    """Grey veins on several scales over a base colour, with clouds of a tint."""
    veins = _cloud(rng, 0.25, 0.2) + 0.6 * _cloud(rng, 0.06, 0.05) + 0.35 * _cloud(rng, 0.012, 0.012)
    colour: np.ndarray = np.array(base) + 34 * veins[..., None]
    colour += 22 * _cloud(rng, 0.4, 0.3)[..., None] * np.array(tint)
    return colour


def _granite(rng: np.random.Generator) -> np.ndarray:
    return _stone(rng, (120, 118, 126), (1.0, -0.2, 0.8))


def _marble(rng: np.random.Generator) -> np.ndarray:
    return _stone(rng, (168, 150, 120), (-0.4, 0.2, 1.0))


def _oak(rng: np.random.Generator) -> np.ndarray:
    board = _strips(rng, TILE[1], 0.12, 0.2)
    grain = 1 + 0.14 * _cloud(rng, 0.3, 0.008) + 0.1 * _cloud(rng, 0.2, 0.15)
    boards = _palette(rng, [(176, 128, 72), (150, 104, 58)], TILE[1], 0.12)[board]
    colour: np.ndarray = boards * grain[..., None]
    return colour


def _plaid(rng: np.random.Generator) -> np.ndarray:
    colours: list[_Tint] = [(178, 34, 46), (24, 54, 92), (220, 196, 120), (30, 92, 66)]
    warp = _palette(rng, colours, TILE[0], 0.1)[_strips(rng, TILE[0], 0.03, 0.14)]
    weft = _palette(rng, colours, TILE[1], 0.1)[_strips(rng, TILE[1], 0.03, 0.14)]
    colour: np.ndarray = 0.6 * warp[:, None] + 0.4 * weft[None]
    return colour


def _leather(rng: np.random.Generator) -> np.ndarray:
    shade = 1 + 0.25 * _cloud(rng, 0.15, 0.15) + 0.1 * _cloud(rng, 0.012, 0.012)
    return np.array((112.0, 52, 36)) * shade[..., None]


def _cardboard(rng: np.random.Generator) -> np.ndarray:
    shade = 1 + 0.08 * _cloud(rng, 0.2, 0.2) + 0.04 * _cloud(rng, 0.01, 0.3)
    colour = np.array((188.0, 150, 102)) * shade[..., None]
    tape = np.isin(_strips(rng, TILE[0], 0.08, 0.3) % 4, 0)[:, None, None]
    return np.where(tape, 0.5 * colour + 90, colour)


def _books(rng: np.random.Generator) -> np.ndarray:
    colours: list[_Tint] = [
        (150, 30, 36),
        (24, 72, 112),
        (228, 214, 178),
        (36, 96, 60),
        (210, 140, 30),
        (60, 40, 74),
    ]
    shelves = []
    for _ in range(0, TILE[1], 32):
        spine = _strips(rng, TILE[0], 0.02, 0.06)
        shelf = np.repeat(_palette(rng, colours, TILE[0], 0.15)[spine][:, None], 32, axis=1)
        shelf[:, :2] = (70, 48, 30)
        shelf[:, 26:] *= rng.uniform(0.25, 1, TILE[0])[spine][:, None, None]
        shelves.append(shelf)
    return np.concatenate(shelves, axis=1)


def _mosaic(rng: np.random.Generator) -> np.ndarray:
    colours: list[_Tint] = [(230, 180, 60), (40, 90, 140), (170, 50, 60), (232, 226, 210), (60, 130, 100)]
    return _stained(rng, _bricks(rng, (0.12, 0.12), colours, (50, 50, 54), 0.1), (240, 210, 120), 0.6)


def _plain(colour: _Tint) -> Callable[[np.random.Generator], np.ndarray]:
    return lambda _: np.broadcast_to(np.array(colour), (*TILE, 3))


MATERIALS = MappingProxyType(
    {
        "brick": _brick,
        "timber": _timber,
        "tiles": _tiles,
        "granite": _granite,
        "marble": _marble,
        "oak": _oak,
        "plaid": _plaid,
        "leather": _leather,
        "cardboard": _cardboard,
        "books": _books,
        "mosaic": _mosaic,
        "white": _plain((226, 226, 222)),
        "blue": _plain((40, 70, 180)),
    }
)
"""Recipes by name: a generator in, colours in 0..255 out."""


@cache
def texture(name: str) -> Texture:
    """Make the tile of a material, (1024, 128, 3) uint8: first along the wall, then from the floor up."""
    rng = np.random.default_rng(list(name.encode()))
    tile: Texture = np.clip(np.rint(MATERIALS[name](rng)), 0, 255).astype(np.uint8)
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
