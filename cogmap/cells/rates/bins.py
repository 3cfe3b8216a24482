"""Bins that views are counted in: a grid over the room, a ring of headings."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int, Shaped
from scipy import ndimage, sparse

from cogmap.cells.rates.ratios import ratio
from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, checked_array

ON_EDGE = 1e-6
"""A position this near (m) to the outermost edges is on them: multiples of a bin are not exact in binary."""

MOST_BINS = 50_000
"""A room of 11 by 11 m has so many bins of 5 cm; of more, each needs a view on average."""


class BinEdges(NamedTuple):
    """The edges in m of a grid of bins; unpacks as `x_edges, y_edges`."""

    x: Float[np.ndarray, "x_edges"]
    y: Float[np.ndarray, "y_edges"]

    @property
    def shape(self) -> tuple[int, int]:
        """The number of bins, (ny, nx)."""
        return len(self.y) - 1, len(self.x) - 1

    @property
    def side(self) -> float:
        """The side of a bin in m."""
        return float(self.x[1] - self.x[0])

    @property
    def centres(self) -> tuple[Float[np.ndarray, "nx"], Float[np.ndarray, "ny"]]:
        """The middles of the bins in m, along x and along y."""
        return (self.x[1:] + self.x[:-1]) / 2, (self.y[1:] + self.y[:-1]) / 2

    def bin_of(self, positions: Float[np.ndarray, "views 2"]) -> Int[np.ndarray, "views"]:
        """Which bin of the flattened (ny, nx) grid each position (m) is in, −1 when outside it."""
        column, row = (
            np.clip(np.searchsorted(edges, along, side="right") - 1, 0, len(edges) - 2)
            for edges, along in zip(self, positions.T, strict=True)
        )
        outside = (positions < [self.x[0] - ON_EDGE, self.y[0] - ON_EDGE]) | (
            positions > [self.x[-1] + ON_EDGE, self.y[-1] + ON_EDGE]
        )
        return np.where(outside.any(axis=1), -1, row * (len(self.x) - 1) + column)

    def visited(self, positions: Float[np.ndarray, "views 2"]) -> Bool[np.ndarray, "ny nx"]:
        """Where these positions (m) have been: the bins that hold one, closed by a square of 3×3 bins.

        A few thousand views miss some reachable bins by chance. The morphological closing fills holes and
        gaps up to two bins wide, except in a corner, and moves neither an outer border nor that of a wider
        obstacle.
        """
        bins = self.bin_of(positions)
        counts = np.bincount(bins[bins >= 0], minlength=self.shape[0] * self.shape[1])
        seen = np.pad(counts.reshape(self.shape) > 0, 2)
        closed: np.ndarray = ndimage.binary_closing(seen, structure=np.ones((3, 3), dtype=bool))
        return closed[2:-2, 2:-2]


def bin_edges(
    positions: AnyArray,
    bin: float = 0.1,  # noqa: A002
) -> BinEdges:
    """Lay square bins over the bounding box of positions, with edges at whole multiples of the bin.

    Parameters
    ----------
    positions
        In m, (views, 2).
    bin
        The side of a bin in m.

    Raises
    ------
    CogmapError
        When `positions` is not a finite (views, 2) array or `bin` is not positive, and for more bins than
        views and than `MOST_BINS`: positions are then hardly in m.
    """
    positions = checked_array("positions", positions, (None, 2))
    if not (np.isfinite(bin) and bin > 0):
        raise CogmapError(f"bin is {bin} m; give the side of a bin as a positive number of metres")
    first = np.floor((positions.min(axis=0) + ON_EDGE) / bin).astype(int)
    last = np.maximum(np.ceil((positions.max(axis=0) - ON_EDGE) / bin).astype(int), first + 1)
    columns, rows = (last - first).tolist()
    if columns * rows > max(MOST_BINS, len(positions)):
        wide, deep = np.ptp(positions, axis=0)
        raise CogmapError(
            f"{len(positions)} positions spread over {wide:g} by {deep:g} make {columns} by {rows} bins of "
            f"{bin:g}; are they in centimetres or pixels? Turn them into metres, or give bin= in their own "
            f"unit: {max(wide, deep) / 50:.1g} makes some 50 bins along the longer side"
        )
    x, y = (np.arange(low, high + 1) * bin for low, high in zip(first, last, strict=True))
    return BinEdges(x, y)


def heading_bin(headings: Float[np.ndarray, "views"], bins: int) -> Int[np.ndarray, "views"]:
    """Which of equal bins around the circle each heading (rad) is in; the first starts at −π.

    Raises
    ------
    CogmapError
        When there are fewer than three bins, too few to have a direction.
    """
    if bins < 3:
        raise CogmapError(f"{bins} heading bins cannot tell a direction; give at least 3")
    return np.floor((headings.astype(float) + np.pi) * (bins / (2 * np.pi))).astype(int) % bins


def heading_centres(bins: int) -> Float[np.ndarray, "bins"]:
    """Give the middles of equal bins around the circle in rad, in the order of `heading_bin`."""
    return np.asarray(-np.pi + (np.arange(bins) + 0.5) * (2 * np.pi / bins))


def sums_by_bin(
    index: Int[np.ndarray, "views"], bins: int, values: Shaped[np.ndarray, "views cells"]
) -> Float[np.ndarray, "bins cells"]:
    """Add up the rows of `values` that fall in the same bin; rows of bin −1 are left out."""
    views = np.flatnonzero(index >= 0)
    member = sparse.csr_array(
        (np.ones(len(views)), (index[views], views)),
        shape=(bins, len(index)),
    )
    return np.asarray(member @ values)


def means_by_bin(
    index: Int[np.ndarray, "views"],
    bins: int,
    values: Shaped[np.ndarray, "views cells"],
    counted: Bool[np.ndarray, "views cells"] | None = None,
) -> Float[np.ndarray, "bins cells"]:
    """Average the rows of `values` that fall in the same bin, NaN in an empty one.

    With `counted`, each cell averages over its own choice of views only.
    """
    if counted is None:
        counted, chosen = np.ones((len(index), 1), dtype=bool), values
    else:
        chosen = values * counted
    sums, counts = sums_by_bin(index, bins, chosen), sums_by_bin(index, bins, counted)
    return ratio(sums, counts)
