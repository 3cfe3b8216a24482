"""Texture sampling: the kernels that lay textures and plain colours on the rows of one image column.

A column is red, green, blue and a spare number for every row, summed up part by part. Whatever is laid on a
row is the mean over the area that the row covers there, so that the image changes smoothly as the eye moves.
"""

import typing

import numpy as np

from arena.eye.projection import Lens
from arena.eye.simd import add_between, add_colour, add_over, add_texels, set_texels
from arena.kernels import bare_kernel
from arena.rooms.materials import LEVELS, TEXEL, TILE

BLOCK = 128
"""Loops run over whole blocks of at most this many numbers: what remains after the last is slow, not SIMD."""

BITS = 7
"""A column counts 128 a grey level: half of what two bytes hold, so that no sum of shares ever flows over."""
BLANK = np.uint16(66)
"""An empty column: half a grey level, so that to cut is to round, and what products cut off in the mean."""


class Ground(typing.NamedTuple):
    """A level surface: its colour (0..255) or, if `start` >= 0, its texture and its brightness."""

    red: float
    green: float
    blue: float
    start: int
    light: float


@bare_kernel(forceinline=True)
@typing.no_type_check
def in_blocks(count: int) -> int:
    """Round a count of numbers up to blocks of 32."""
    # A power of two, so that to clear low bits is to round, and four times the eight float32 of AVX2.
    return (count + 31) & ~31


@bare_kernel(forceinline=True)
@typing.no_type_check
def fade_in(stretch: float) -> float:
    """How much of the next coarser level to mix in, so that none comes suddenly: all at 2 texels."""
    # One level is enough up to 1.9 texels: a longer fade would have nearly every wall painted twice. The
    # reciprocal is a constant when compiled, and a product takes less time than a quotient.
    return min(max((stretch - 1.9) * (1.0 / (2.0 - 1.9)), 0.0), 1.0)


@bare_kernel(forceinline=True)
@typing.no_type_check
def lay(colours: np.ndarray, at: int, share: float, column: np.ndarray, row: int) -> None:
    """Add a share (0..1) of a colour to a row: three bytes from an item on."""
    red, green, blue = colours[at], colours[at + 1], colours[at + 2]
    weight = np.uint16(32768.0 * share + 0.5)
    add_colour(np.uint16(red << 8), np.uint16(green << 8), np.uint16(blue << 8), weight, column, row)


@bare_kernel(forceinline=True)
@typing.no_type_check
def _lie(middle: float, half: float, share: float, start: int, across: int, length: int) -> tuple:
    """Where the three columns of texels under a stretch start, and their weights."""
    low, high = middle - half, middle + half
    i = int(np.floor(low))
    # At least one texel wide, as callers see to: the first is covered to its end, and no weight is negative.
    share *= 65535.0 / (high - low)
    second, third = min(high - i - 1.0, 1.0), max(0.0, high - i - 2.0)
    # Tiles are powers of two wide, so that & repeats them, to the left of zero as well.
    a, b = start + length * (i & across - 1), start + length * (i + 1 & across - 1)
    c = start + length * (i + 2 & across - 1)
    return (a, b, c), (
        np.uint16(share * (i + 1.0 - low)),
        np.uint16(share * second),
        np.uint16(share * third),
    )


@bare_kernel(forceinline=True)
@typing.no_type_check
def unroll(
    stretch: tuple,
    up: tuple,
    level: int,
    gain: float,
    start: int,
    texels: np.ndarray,
    level_starts: np.ndarray,
    strip: np.ndarray,
) -> None:
    """Fill `strip` with the texture from texel up[0] to up[1], averaged along a stretch of wall (m).

    It is measured in texels of the level at which it covers one or two, hence touches at most three.
    """
    u0, u1 = min(stretch) * (1.0 / TEXEL), max(stretch) * (1.0 / TEXEL)
    fine = 0
    # Halving is exact: a level is left as smoothly as it was entered.
    while u1 - u0 > 2.0 and fine < LEVELS[0] - 2:
        u0, u1, fine = 0.5 * u0, 0.5 * u1, fine + 1
    fade, length = fade_in(u1 - u0), 4 * (TILE[1] >> level)
    # Over less than one texel: linear interpolation. Over more than two, which happens at the coarsest level
    # only, the middle two: there are three columns to read and no more.
    middle, half = 0.5 * (u0 + u1), min(max(0.5 * (u1 - u0), 0.5), 1.0)
    base, across = start + level_starts[fine, level], TILE[0] >> fine
    (a, b, c), weights = _lie(middle, half, gain * (1.0 - fade), base, across, length)
    v, at = up[0], 0
    while v < up[1]:
        # As far as the tile goes, so that a stretch of texels is read without wrapping.
        skip = 4 * v & length - 1
        n = min(4 * (up[1] - v), length - skip)
        for k in range(0, n, 32):
            set_texels(texels, (a + skip + k, b + skip + k, c + skip + k), weights, strip, at + k)
        if fade > 0.0:  # before the next stretch, which overwrites what either layer leaves beyond this one
            base = start + level_starts[fine + 1, level]
            (d, e, f), faint = _lie(
                0.5 * middle, max(0.5 * half, 0.5), gain * fade, base, across >> 1, length
            )
            for k in range(0, n, 32):
                add_texels(texels, (d + skip + k, e + skip + k, f + skip + k), faint, strip, at + k)
        at += n
        v += n // 4


@bare_kernel(forceinline=True)
@typing.no_type_check
def _part(share: float) -> int:
    """Turn a share (0..1) into parts of 65536, of which all is one too few for two bytes."""
    return np.uint16(min(65536.0 * share, 65535.0))


@bare_kernel(forceinline=True)
@typing.no_type_check
def _position(texels: float) -> int:
    """Turn a place (texels) into whole numbers of 2^-32, rounded to 2^-16: a column errs by .002 at most."""
    return np.int64(np.floor(65536.0 * texels + 0.5)) << 16


@bare_kernel(forceinline=True)
@typing.no_type_check
def row_size(step: float) -> float:
    """How many texels a row averages over that covers so many: at least one, and at most two.

    Less is linear interpolation. More, which happens at the coarsest level only, are the middle two.
    """
    return min(max(step, 1.0), 2.0)


@bare_kernel(forceinline=True)
@typing.no_type_check
def paint_wall(rows: tuple, up: tuple, strip: np.ndarray, column: np.ndarray) -> None:
    """Add a wall to the rows between two image heights; `up` is where on `strip` row 0 is, and texels a row.

    The strip is of texels over twice `row_size(step)`: a column counts half of what the strip does.
    """
    top, bottom = rows
    v, step = up
    size = row_size(step)
    first, last = int(top), int(np.ceil(bottom)) - 1
    low, stride = _position(v - (last - 0.5) * step - 0.5 * size), _position(step)
    if size == 1.0:
        r = last - 1
        # The lowest rows of a wall seen from near would reach up to half a texel below it.
        while low < 0 and r > first:
            add_between(strip, 0, 0, np.uint16(0), None, column, (r, 1))
            low, r = low + stride, r - 1
        add_between(strip, low, stride, np.uint16(0), None, column, (r, r - first))
    else:
        add_over(strip, low, stride, _part(size - 1.0), None, column, (last - 1, last - 1 - first))
    # The first and the last may be covered in part, and may be the same.
    for n in range(2 if first < last else 1):
        r = last if n == 0 else first
        above, below = max(top, float(r)), min(bottom, r + 1.0)
        covered = row_size(step * (below - above))
        low = _position(max(v - 0.5 * (above + below) * step - 0.5 * covered, 0.0))
        share = _part((below - above) * size / covered)
        if size == 1.0:
            add_between(strip, low, 0, np.uint16(0), share, column, (r, 1))
        else:
            add_over(strip, low, 0, _part(covered - 1.0), share, column, (r, 1))


@bare_kernel()
@typing.no_type_check
def _paint_textured_floor(
    rows: tuple,
    weight: float,
    floor: Ground,
    eye: tuple,
    lens: Lens,
    texels: np.ndarray,
    level_starts: np.ndarray,
    column: np.ndarray,
) -> None:
    """Add the texture of the floor to the rows between two image heights.

    `eye` is where the eye stands (m) and the direction in the room of the column's ray. Two levels are mixed,
    bilinear each, whose texels are about as large as the longer side of what the pixel covers.
    """
    (top, bottom), (x, y, dx, dy) = rows, eye
    length = np.sqrt(dx * dx + dy * dy)
    for r in range(int(top), int(np.ceil(bottom))):
        above, below = max(float(r), top), min(r + 1.0, bottom)
        # At the horizon depth is infinite; no part of a row is taken to be nearer to it than a quarter row.
        depth = lens.focal * lens.eye / max(0.5 * (above + below) - 0.5 * lens.height, 0.25)
        side = depth * max(1.0, length * depth / lens.eye) / (lens.focal * TEXEL)
        share, level = np.float32(weight * (below - above) * floor.light), 0
        # A pixel is depth / focal wide and, seen aslant, depth / eye times longer. Up to level 6: the fade
        # takes the next, and 7 is the coarsest up the tile.
        while side >= 2.0 and level < 6:
            side, level = 0.5 * side, level + 1
        fade = min(max(side - 1.0, 0.0), 1.0)
        for one in range(2):
            part = share * np.float32(fade if one == 1 else 1.0 - fade)
            # Half a texel less: a texel's colour is that of its middle.
            width = TEXEL * (1 << level + one)
            u, v = (x + depth * dx) / width - 0.5, (y + depth * dy) / width - 0.5
            # Rooms reach to either side of the origin: int alone would cut negative ones towards it.
            i, j = int(np.floor(u)), int(np.floor(v))
            across, up = TILE[0] >> level + one, TILE[1] >> level + one
            base = floor.start + level_starts[level + one, level + one]
            for p in range(2):
                for q in range(2):
                    w = part * np.float32((u - i if p == 1 else i + 1 - u) * (v - j if q == 1 else j + 1 - v))
                    at = base + 4 * (up * (i + p & across - 1) + (j + q & up - 1))
                    # A product of float32 is off by at most 6e-8 of 255, some 1e-5 of a grey level.
                    lay(texels, at, w, column, r)


@bare_kernel(forceinline=True)
@typing.no_type_check
def paint_ground(
    rows: tuple,
    weight: float,
    ground: Ground,
    eye: tuple,
    lens: Lens,
    scene: tuple,
    column: np.ndarray,
) -> None:
    """Add a level surface to the rows between two image heights."""
    if ground.start >= 0:
        _paint_textured_floor(rows, weight, ground, eye, lens, scene.texels, scene.level_starts, column)
        return
    top, bottom = rows
    red, green, blue = (
        np.uint16(256 * ground.red),
        np.uint16(256 * ground.green),
        np.uint16(256 * ground.blue),
    )
    for r in range(int(top), int(np.ceil(bottom))):
        share = np.uint16(32768 * weight * (min(r + 1.0, bottom) - max(float(r), top)) + 0.5)
        add_colour(red, green, blue, share, column, r)


@bare_kernel(forceinline=True)
@typing.no_type_check
def paint_backdrop(rows: tuple, weight: float, backdrop: np.ndarray, column: np.ndarray) -> None:
    """Add the backdrop to the rows between two image heights."""
    top, bottom = rows
    for r in range(int(top), int(np.ceil(bottom))):
        lay(backdrop, 4 * r, weight * (min(r + 1.0, bottom) - max(float(r), top)), column, r)
