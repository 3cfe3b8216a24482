"""Place by direction: the rates of a cell as a map times a curve, each without what is the other's.

No animal looks everywhere in all directions equally often: where it happened to face the preferred direction
of a head-direction cell, the rate map has a peak, and the fewer the views, the higher.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float
from scipy import ndimage

from cogmap.cells.rates.bins import heading_bin, sums_by_bin
from cogmap.cells.rates.maps import RateMaps
from cogmap.cells.rates.ratios import ratio
from cogmap.threads import one_thread


class PlaceByDirection(NamedTuple):
    """The factors of a population; bins of place are those of `maps.patterns`."""

    rates: Float[np.ndarray, "cells bins"]
    """p(x) in Hz, of an animal that looks everywhere in all directions equally often."""
    gains: Float[np.ndarray, "cells directions"]
    """d(θ) in the bins of `heading_bin`, of mean 1; NaN without views, or of a silent cell."""
    exposure: Float[np.ndarray, "cells bins"]
    """Views at a place, each counted with the gain of its direction: what p is known from."""


def place_by_direction(
    rates: Float[np.ndarray, "views cells"],
    positions: Float[np.ndarray, "views 2"],
    headings: Float[np.ndarray, "views"],
    maps: RateMaps,
    inside: Bool[np.ndarray, "cells ny nx"],
    *,
    bins: int,
    smoothing: float = 0.15,
    rounds: int = 10,
) -> PlaceByDirection:
    """Factorise the rate of every cell, r(x, θ) = p(x) d(θ), by maximum likelihood, in turn

        p(x) = λ(x) / Σ_θ s(θ|x) d(θ),        d(θ) = Σ r / Σ_x o(x, θ) p(x),

    where λ is the rate map, o counts the views, s is the share of each direction in those near x, and the
    sums of d run over the views in the direction θ and inside.

    Parameters
    ----------
    rates, positions, headings
        In Hz, m and rad.
    maps
        λ.
    inside
        Where each cell's d is taken, for example its fields.
    bins
        Of direction.
    smoothing
        Of s, the standard deviation of a Gaussian in m: that of the maps.
    rounds
        A tenth changes information by less than .003 bit/spike.

    References
    ----------
    Burgess, Cacucci, Lever & O'Keefe 2005, Characterizing multiple independent behavioral correlates of cell
    firing in freely moving animals, Hippocampus 15. Muller, Bostock, Taube & Kubie 1994, On the directional
    firing properties of hippocampal place cells, J. Neurosci. 14.
    """  # noqa: D400
    edges, visited = maps.edges, maps.visited
    place, direction = edges.bin_of(positions), heading_bin(headings, bins)
    both = np.where(place >= 0, place * bins + direction, -1)
    counts = sums_by_bin(both, visited.size * bins, np.ones((len(both), 1))).reshape(*visited.shape, bins)
    nearby = ndimage.gaussian_filter(counts, smoothing / edges.side, mode="constant", axes=(0, 1))[visited]
    views, share = counts[visited], np.nan_to_num(ratio(nearby, nearby.sum(axis=1, keepdims=True)))
    counted = inside.reshape(len(maps), -1)[:, place].T & (place >= 0)[:, None]
    fired = sums_by_bin(direction, bins, rates * counted).T
    here, gain = inside[:, visited], np.ones((len(maps), bins))
    with one_thread():
        for _ in range(rounds):
            # A place where the cell never fires in the directions looked in has no rate: 0 / 0.
            placed = np.nan_to_num(ratio(maps.patterns, gain @ share.T))
            gains = ratio(fired, (placed * here) @ views)
            known = np.sum(~np.isnan(gains), axis=1, dtype=float)
            gains = ratio(gains * known[:, None], np.nansum(gains, axis=1, keepdims=True))
            gain = np.where(np.isnan(gains), 1.0, gains)
        return PlaceByDirection(placed, gains, gain @ views.T)
