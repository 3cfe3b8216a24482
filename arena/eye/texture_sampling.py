"""Texture sampling: the kernels that lay textures and plain colours on the rows of one image column.

A column is red, green, blue and a spare number for every row, summed up part by part. Whatever is laid on a
row is the mean over the area that the row covers there, so that the image changes smoothly as the eye moves.
"""

import typing

import numpy as np

from arena.eye.raycast import Lens
from arena.eye.simd import add_three
from arena.kernels import kernel
from arena.rooms.materials import LEVELS, TEXEL, TILE

BLOCK = 128
"""Loops run over whole blocks of at most this many numbers: what remains after the last is slow, not SIMD."""


class Ground(typing.NamedTuple):
    """A level surface: its colour (0..255) or, if `start` >= 0, its texture and its brightness."""

    red: float
    green: float
    blue: float
    start: int
    light: float


@kernel(forceinline=True)
@typing.no_type_check
def in_blocks(count: int) -> int:
    """Round a count of numbers up to blocks of 32."""
    # A power of two, so that to clear low bits is to round, and four times the eight float32 of AVX2.
    return (count + 31) & ~31


@kernel(forceinline=True)
@typing.no_type_check
def fade_in(stretch: float) -> float:
    """How much of the next coarser level to mix in, so that none comes suddenly: all at 2 texels."""
    # One level is enough up to 1.9 texels: a longer fade would have nearly every wall painted twice. The
    # reciprocal is a constant when compiled, and a product takes less time than a quotient.
    return min(max((stretch - 1.9) * (1.0 / (2.0 - 1.9)), 0.0), 1.0)


@kernel(forceinline=True)
@typing.no_type_check
def _blend(
    texels: np.ndarray,
    starts: tuple,
    skip: int,
    weight: tuple,
    strip: np.ndarray,
    at: int,
    count: int,
    layer: int,
) -> None:
    """Fill part of `strip` with a weighted sum of three stretches of texels; a second layer is added."""
    # Unsigned: a signed index might count from the end, and to look at its sign each time rules SIMD out.
    a, b, c = np.uint64(starts[0] + skip), np.uint64(starts[1] + skip), np.uint64(starts[2] + skip)
    wa, wb, wc = weight
    to, length, keep = np.uint64(at), in_blocks(count), np.float32(layer)
    # Two loops without a branch inside, since a third of no weight need not be read. The first layer takes
    # what was there before times zero, so the strip must never have held an inf or NaN.
    if layer > 0 or wc > 0:
        for n in range(length):
            k = np.uint64(n)
            mean = wa * np.float32(texels[a + k]) + wb * np.float32(texels[b + k])
            strip[to + k] = mean + wc * np.float32(texels[c + k]) + keep * strip[to + k]
    else:
        for n in range(length):
            k = np.uint64(n)
            strip[to + k] = wa * np.float32(texels[a + k]) + wb * np.float32(texels[b + k])


@kernel(forceinline=True)
@typing.no_type_check
def _lie(middle: float, half: float, share: float, start: int, across: int, length: int) -> tuple:
    """Where the three columns of texels under a stretch start, and their weights."""
    low, high = middle - half, middle + half
    i = int(np.floor(low))
    # At least one texel wide, as callers see to: the first is covered to its end, and no weight is negative.
    share /= high - low
    second, third = min(high - i - 1.0, 1.0), max(0.0, high - i - 2.0)
    # Tiles are powers of two wide, so that & repeats them, to the left of zero as well.
    a, b = start + length * (i & across - 1), start + length * (i + 1 & across - 1)
    c = start + length * (i + 2 & across - 1)
    weights = np.float32(share * (i + 1.0 - low)), np.float32(share * second), np.float32(share * third)
    return (a, b, c), weights


@kernel(forceinline=True)
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
    starts, weight = _lie(middle, half, gain * (1.0 - fade), base, across, length)
    v, at = up[0], 0
    while v < up[1]:
        # As far as the tile goes, so that a stretch of texels is read without wrapping.
        skip = 4 * v & length - 1
        n = min(4 * (up[1] - v), length - skip)
        _blend(texels, starts, skip, weight, strip, at, n, 0)
        if fade > 0.0:  # before the next stretch, which overwrites what either layer leaves beyond this one
            base = start + level_starts[fine + 1, level]
            more, faint = _lie(0.5 * middle, max(0.5 * half, 0.5), gain * fade, base, across >> 1, length)
            _blend(texels, more, skip, faint, strip, at, n, 1)
        at += n
        v += n // 4


@kernel(forceinline=True)
@typing.no_type_check
def _weigh(low: np.float32, size: np.float32, share: np.float32) -> tuple:
    """Weights of the three texels under a stretch of one to two, and the first of them."""
    # The lowest row of a wall seen from near would reach up to half a texel below it.
    low = max(low, np.float32(0.0))
    # Not negative any more, so that cutting towards zero is the floor. Constants are float32, too: one of
    # double precision would make the whole loop so, and SIMD would take half as many at a time.
    texel = np.int32(low)
    rest = low - np.float32(texel)
    beyond = rest + size - np.float32(1.0)
    second, third = min(beyond, np.float32(1.0)), max(beyond - np.float32(1.0), np.float32(0.0))
    return texel, share * (np.float32(1.0) - rest), share * second, share * third


@kernel(forceinline=True)
@typing.no_type_check
def paint_wall(
    rows: tuple,
    weight: float,
    up: tuple,
    strip: np.ndarray,
    texel: np.ndarray,
    mix: tuple,
    column: np.ndarray,
) -> None:
    """Add a wall to the rows between two image heights; `up` is where on `strip` row 0 is, and texels a row.

    A row averages over what it covers, but never over less than a texel, which is linear interpolation.
    """
    top, bottom = rows
    v, step = up
    first = int(top)
    # float32 fills SIMD twice as well; on a strip of 128 texels it errs by 1e-5 of one.
    count = int(np.ceil(bottom)) - first
    size, stride = np.float32(max(step, 1.0)), np.float32(step)
    low, share = np.float32(v - (first + 0.5) * step) - np.float32(0.5) * size, np.float32(weight) / size
    t, (a, b, c) = texel, mix
    for k in range(in_blocks(count)):
        # From the first row, not from the row before: errors do not add up, and rows do not wait.
        t[k], a[k], b[k], c[k] = _weigh(low - np.float32(k) * stride, size, share)
    # These may be covered in part. They are set again, since a test within the loop would rule SIMD out; one
    # row that is both is set twice, not added twice.
    for k in (0, count - 1):
        above, below = max(top, float(first + k)), min(bottom, first + k + 1.0)
        size = np.float32(max(step * (below - above), 1.0))
        low, share = np.float32(v - 0.5 * (above + below) * step), np.float32(weight * (below - above)) / size
        t[k], a[k], b[k], c[k] = _weigh(low - np.float32(0.5) * size, size, share)
    for k in range(count):
        add_three(strip, t[k], a[k], b[k], c[k], column, first + k)


@kernel()
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
                    for k in range(3):
                        column[4 * r + k] += w * np.float32(texels[at + k])


@kernel(forceinline=True)
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
    for r in range(int(top), int(np.ceil(bottom))):
        share = np.float32(weight * (min(r + 1.0, bottom) - max(float(r), top)))
        column[4 * r] += share * np.float32(ground.red)
        column[4 * r + 1] += share * np.float32(ground.green)
        column[4 * r + 2] += share * np.float32(ground.blue)


@kernel(forceinline=True)
@typing.no_type_check
def paint_backdrop(rows: tuple, weight: float, backdrop: np.ndarray, behind: int, column: np.ndarray) -> None:
    """Add the backdrop to the rows between two image heights."""
    top, bottom = rows
    for r in range(int(top), int(np.ceil(bottom))):
        share = np.float32(weight * (min(r + 1.0, bottom) - max(float(r), top)))
        for c in range(3):
            column[4 * r + c] += share * np.float32(backdrop[behind, 4 * r + c])
