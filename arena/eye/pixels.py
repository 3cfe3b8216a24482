"""Pixels: the kernels that turn painted columns into the rows of an image.

Columns come in fours, each red, green, blue and a spare byte a row, since twelve bytes are three whole words:
to write an image of three-byte pixels column by column takes several times as long.
"""

import typing

import numpy as np

from arena.eye.texture_sampling import in_blocks
from arena.kernels import kernel


@kernel(forceinline=True)
@typing.no_type_check
def finish(
    rows: tuple,
    visible: tuple,
    backdrop: np.ndarray,
    behind: int,
    column: np.ndarray,
    quad: np.ndarray,
    slot: int,
) -> None:
    """Cut rows of a column to whole grey levels; the others that are visible are backdrop."""
    # Unsigned for SIMD, as in `arena.eye.texture_sampling`.
    at, source = np.uint64(slot), np.uint64(behind)
    for n in range(in_blocks(4 * (visible[1] - visible[0]))):
        k = np.uint64(4 * visible[0]) + np.uint64(n)
        quad[at, k] = backdrop[source, k]
    # No clip: the weights on a row add up to one, so that a sum lies between 0.5 and 255.5 but for rounding
    # errors far below a half. By way of int32, the only whole numbers that SIMD turns float32 into.
    for n in range(in_blocks(4 * (rows[1] - rows[0]))):
        k = np.uint64(4 * rows[0]) + np.uint64(n)
        quad[at, k] = np.uint8(np.int32(column[k]))
    for n in range(32):  # these may have been cut, too
        k = np.uint64(4 * rows[1]) + np.uint64(n)
        quad[at, k] = backdrop[source, k]


@kernel()
@typing.no_type_check
def emit(quad: np.ndarray, c: int, count: int, visible: tuple, out: np.ndarray) -> None:
    """Copy up to four columns into the image."""
    # Rows outside, so that what is written lies together: the four columns that are read stay in the cache.
    for r in range(visible[0], visible[1]):
        for q in range(count):
            for k in range(3):
                out[r, c + q, k] = quad[q, 4 * r + k]


@kernel(forceinline=True)
@typing.no_type_check
def emit_words(quad: np.ndarray, c: int, visible: tuple, out: np.ndarray) -> None:
    """Copy four columns into the image, three words a row."""
    # All of uint32: numba makes 64 bits of a sum with one of Python's numbers, half as many at a time.
    at = np.uint32(c // 4 * 3)
    one, two = np.uint32(1), np.uint32(2)
    b, g, d = np.uint32(8), np.uint32(16), np.uint32(24)
    # Little-endian: red is the lowest byte. The spare byte is zero, so that | puts pixels side by side.
    for r in range(visible[0], visible[1]):
        p0, p1, p2, p3 = quad[0, r], quad[1, r], quad[2, r], quad[3, r]
        out[r, at] = p0 | p1 << d
        out[r, at + one] = p1 >> b | p2 << g
        out[r, at + two] = p2 >> g | p3 << b


@kernel()
@typing.no_type_check
def fill(first: int, last: int, backdrop: np.ndarray, out: np.ndarray, words: np.ndarray) -> None:
    """Copy rows that are nothing but backdrop into the image."""
    # All columns alike: three words hold four pixels, and are the same along the row.
    if len(words) > 0 and len(backdrop) == 1:
        b, g, d = np.uint32(8), np.uint32(16), np.uint32(24)
        for r in range(first, last):
            red, green, blue = backdrop[0, 4 * r], backdrop[0, 4 * r + 1], backdrop[0, 4 * r + 2]
            p = np.uint32(red) | np.uint32(green) << b | np.uint32(blue) << g
            for w in range(0, words.shape[1], 3):
                words[r, w], words[r, w + 1], words[r, w + 2] = p | p << d, p >> b | p << g, p >> g | p << b
        return
    for r in range(first, last):
        for c in range(out.shape[1]):
            for k in range(3):
                out[r, c, k] = backdrop[c if len(backdrop) > 1 else 0, 4 * r + k]
