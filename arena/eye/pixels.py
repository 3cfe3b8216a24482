"""Pixels: the kernels that turn painted columns into the rows of an image.

Columns come in fours, each red, green, blue and a spare byte a row: to write an image of three-byte pixels
column by column takes several times as long.
"""

import typing

import numpy as np

from arena.eye.simd import write_four
from arena.eye.texture_sampling import BITS, BLANK, in_blocks, lay
from arena.kernels import bare_kernel


@bare_kernel(forceinline=True)
@typing.no_type_check
def finish(
    parts: np.ndarray,
    count: int,
    backdrop: np.ndarray,
    column: np.ndarray,
    quad: np.ndarray,
    rows: np.ndarray,
) -> None:
    """Cut a column to whole grey levels and make it blank; `rows` becomes which are more than backdrop.

    Each of its `parts` tells which rows it has painted and how much of the column it fills.
    """
    first, last = parts[0].first, parts[0].last
    for p in range(1, count):
        first, last = min(first, parts[p].first), max(last, parts[p].last)
    # Where some parts have painted the others are backdrop.
    for p in range(count if count > 1 else 0):
        one = parts[p]
        for r in range(first, one.first):
            lay(backdrop, 4 * r, one.share, column, r)
        for r in range(one.last, last):
            lay(backdrop, 4 * r, one.share, column, r)
    # Unsigned for SIMD, as in `arena.eye.texture_sampling`. No clip: the weights on a row add up to one.
    for n in range(in_blocks(4 * (last - first))):
        k = np.uint64(4 * first) + np.uint64(n)
        quad[k] = np.uint8(column[k] >> BITS)
        column[k] = BLANK
    rows[0], rows[1] = first, last


@bare_kernel(forceinline=True)
@typing.no_type_check
def emit(
    quad: np.ndarray, rows: np.ndarray, c: int, count: int, backdrop: np.ndarray, out: np.ndarray
) -> None:
    """Copy the rows of up to four columns into the image; columns to the right of them are copied later."""
    first, last = rows[0, 0], rows[0, 1]
    for q in range(1, count):
        first, last = min(first, rows[q, 0]), max(last, rows[q, 1])
    # Four rows at a time: that there may be more of them than painted does no harm.
    first = max(min(first, last - 4), 0)
    for q in range(count):
        behind = backdrop[c + q if len(backdrop) > 1 else 0]
        for k in range(4 * first, 4 * rows[q, 0]):
            quad[np.uint64(q), np.uint64(k)] = behind[np.uint64(k)]
        for k in range(4 * rows[q, 1], 4 * last):
            quad[np.uint64(q), np.uint64(k)] = behind[np.uint64(k)]
    if count == 4 and last - first >= 4:
        # The last four rows may have been written already, as there need not be a multiple of four.
        for r in range(first, last, 4):
            write_four(quad, min(r, last - 4), out, c)
        return
    # Rows outside, so that what is written lies together: the columns that are read stay in the cache.
    for r in range(first, last):
        for q in range(count):
            for k in range(3):
                out[r, 3 * (c + q) + k] = quad[q, 4 * r + k]


@bare_kernel()
@typing.no_type_check
def copy(image: np.ndarray, out: np.ndarray) -> None:
    """Copy an image."""
    for r in range(len(out)):
        for k in range(out.shape[1]):
            out[np.uint64(r), np.uint64(k)] = image[np.uint64(r), np.uint64(k)]
