"""Place fields: the regions of a rate map where a cell fires."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import ndimage

from cogmap.cells.rates.maps import RateMaps
from cogmap.cells.rates.ratios import ratio
from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray


@dataclass(frozen=True, eq=False)
class PlaceFields:
    """The fields of a population, on the bins of its rate maps."""

    labels: Int[np.ndarray, "cells ny nx"]
    """0 outside, then 1, 2, ... from the largest field of the cell to its smallest."""
    number: Int[np.ndarray, "cells"]
    """Fields per cell."""
    area: Float[np.ndarray, "cells"]
    """Of the largest field in m², 0 without one."""
    centre: Float[np.ndarray, "cells 2"]
    """Centroid of the largest field weighted by rate, in m, NaN without one."""

    @property
    def masks(self) -> Bool[np.ndarray, "cells ny nx"]:
        """Whether a bin is in any field of the cell."""
        return self.labels > 0


def place_fields(
    maps: RateMaps, *, threshold: float = 0.3, least_area: float = 0.05, most_share: float = 0.5
) -> PlaceFields:
    """Find the fields of every cell.

    A field is a region of bins that share edges (4-connected) where the rate is high, neither too small nor
    too large.

    Parameters
    ----------
    maps
        Of the population.
    threshold
        The least rate in a field, as a part of the cell's peak.
    least_area
        Of a field, m²: five bins of 0.1 m.
    most_share
        Of the visited area that a field may take: a uniform cell has none.
    """
    peak = np.nanmax(maps.rates, axis=(1, 2), keepdims=True)
    above = (maps.rates >= threshold * peak) & (peak > 0)
    within_a_cell = np.zeros((3, 3, 3), dtype=bool)
    within_a_cell[1] = ndimage.generate_binary_structure(2, 1)
    regions, _ = ndimage.label(above, within_a_cell)
    found, first, size = np.unique(regions, return_index=True, return_counts=True)
    # Half a bin of slack: five bins of 0.01 m² are 0.05 m² whatever the rounding.
    enough = size > least_area / maps.bin_area - 0.5
    kept = (found > 0) & enough & (size <= most_share * maps.visited.sum())
    cell = first // maps.occupancy.size
    largest_first = np.lexsort((-size, cell))
    largest_first = largest_first[kept[largest_first]]
    number = np.bincount(cell[largest_first], minlength=len(maps))
    renamed = np.zeros(len(found), dtype=int)
    renamed[largest_first] = 1 + np.arange(kept.sum()) - np.repeat(np.cumsum(number) - number, number)
    labels = renamed[np.searchsorted(found, regions)]
    largest = labels == 1
    return PlaceFields(labels, number, largest.sum(axis=(1, 2)) * maps.bin_area, _centroid(maps, largest))


def place_coverage(fields: PlaceFields, passing: AnyArray, reachable: AnyArray) -> float:
    """Part of the reachable area that is inside a field of some passing cell.

    Parameters
    ----------
    fields
        From `place_fields`.
    passing
        Which cells count, the column `passing` of `place_statistics`.
    reachable
        Which bins count, for example `maps.visited`.

    Raises
    ------
    CogmapError
        When the shapes do not fit the fields or nothing is reachable.
    """
    passing, reachable = np.asarray(passing, bool), np.asarray(reachable, bool)
    if (len(passing), *reachable.shape) != fields.labels.shape:
        raise CogmapError(
            f"{len(passing)} cells and {reachable.shape} bins do not fit fields of shape "
            f"{fields.labels.shape}; take them from the same rate maps"
        )
    if not reachable.any():
        raise CogmapError("no bin is reachable; mark at least one")
    covered = fields.masks[passing].any(axis=0)
    return float(covered[reachable].mean())


def _centroid(maps: RateMaps, mask: Bool[np.ndarray, "cells ny nx"]) -> Float[np.ndarray, "cells 2"]:
    weight = np.where(mask, maps.rates, 0.0)
    x, y = maps.edges.centres
    moment = np.stack([np.sum(weight * x, axis=(1, 2)), np.sum(weight * y[:, None], axis=(1, 2))], axis=1)
    return ratio(moment, weight.sum(axis=(1, 2))[:, None])
