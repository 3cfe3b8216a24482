"""Rate maps: how much a cell fires at each place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy import ndimage

from cogmap.cells.rates.bins import BinEdges, bin_edges, sums_by_bin
from cogmap.cells.rates.ratios import ratio
from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, checked_array, checked_rates


@dataclass(frozen=True, eq=False)
class RateMaps:
    """Rate maps of a population on one grid; as an array `rates`; `maps[3]` is that of cell 3."""

    rates: Float[np.ndarray, "cells ny nx"]
    """In Hz, NaN where never visited; row 0 is the lowest y."""
    occupancy: Float[np.ndarray, "ny nx"]
    """Views per bin, not smoothed; 0 where never visited."""
    edges: BinEdges
    """In m, along x and along y."""

    @property
    def visited(self) -> Bool[np.ndarray, "ny nx"]:
        """The bins that have a rate."""
        return np.asarray(~np.isnan(self.rates[0]))

    @property
    def bin_area(self) -> float:
        """The area of one bin in m²."""
        return self.edges.side**2

    @property
    def patterns(self) -> Float[np.ndarray, "cells bins"]:
        """Rates in Hz in the visited bins alone: the population vector of each."""
        return np.asarray(self.rates[:, self.visited])

    @property
    def places(self) -> Float[np.ndarray, "bins 2"]:
        """Where the bins of `patterns` are centred, m."""
        x, y = np.meshgrid(*self.edges.centres)
        return np.stack([x[self.visited], y[self.visited]], axis=1)

    def of_cells(self, cells: int) -> RateMaps:
        """Give these maps back when they are of so many cells.

        Raises
        ------
        CogmapError
            When they are not.
        """
        if len(self) != cells:
            raise CogmapError(f"{len(self)} maps for {cells} cells; take the maps of the same cells")
        return self

    def __array__(self, dtype: np.dtype | None = None, copy: bool | None = None) -> np.ndarray:  # noqa: FBT001
        return np.array(self.rates, dtype=dtype, copy=copy)

    def __getitem__(self, cell: int) -> Float[np.ndarray, "ny nx"]:
        return np.asarray(self.rates[cell])

    def __len__(self) -> int:
        return len(self.rates)


def rate_maps(
    rates: AnyArray,
    positions: AnyArray,
    bin: float = 0.1,  # noqa: A002
    smoothing: float = 0.15,
    *,
    edges: BinEdges | None = None,
    visited: AnyArray | None = None,
) -> RateMaps:
    """Map the mean rate of every cell over the room, each view counting as one unit of occupancy.

    λ = (G * S) / (G * O), where O counts the views of a bin, S adds up their rates, and G is a Gaussian that
    ends at the border of the grid for both alike, so that a constant rate stays constant.

    Parameters
    ----------
    rates
        In Hz, (views, cells).
    positions
        In m, (views, 2).
    bin
        The side of a bin in m.
    smoothing
        The standard deviation of G in m; 0 for none.
    edges
        Bins to use instead of those of the bounding box, so that several populations share them; positions
        outside are left out.
    visited
        Where there is a rate; by default `edges.visited(positions)`. Give it when other recordings know the
        room better: a bin there that these views missed is filled from within 4 `smoothing`.

    Raises
    ------
    CogmapError
        For rates that are negative or not finite, shapes that do not fit, bins that are not `bin` wide, and
        positions that are hardly in the unit of `bin` (`bin_edges`).
    """
    rates = checked_rates(rates)
    positions = checked_array("positions", positions, (len(rates), 2))
    if not (np.isfinite(smoothing) and smoothing >= 0):
        raise CogmapError(f"smoothing is {smoothing} m; give a standard deviation of 0 m or more")
    if edges is None:
        edges = bin_edges(positions, bin)
    elif not np.allclose(np.concatenate([np.diff(along) for along in edges]), bin):
        raise CogmapError(f"edges are not {bin:g} m apart; make them with bin_edges(positions, {bin:g})")
    visited = edges.visited(positions) if visited is None else np.asarray(visited, bool)
    if visited.shape != edges.shape:
        raise CogmapError(f"visited has shape {visited.shape}, but the edges make {edges.shape} bins")
    index, bins = edges.bin_of(positions), edges.shape[0] * edges.shape[1]
    views, spikes = (
        sums_by_bin(index, bins, values).T.reshape(-1, *edges.shape)
        for values in (np.ones((len(rates), 1)), rates)
    )
    occupancy = np.where(visited, views[0], 0.0)
    if not occupancy.any():
        raise CogmapError("no position is in a bin that counts; give edges and visited in metres around them")
    smooth_views, smooth_spikes = (
        ndimage.gaussian_filter(counts, smoothing / bin, mode="constant", axes=(1, 2))
        for counts in (views, spikes)
    )
    return RateMaps(ratio(smooth_spikes, np.where(visited, smooth_views, 0.0)), occupancy, edges)
