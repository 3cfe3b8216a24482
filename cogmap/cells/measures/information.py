"""Spatial information: how much the rate of a cell tells about the place."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy import special

from cogmap.cells.rates.maps import RateMaps
from cogmap.cells.rates.ratios import ratio


def spatial_information(maps: RateMaps) -> Float[np.ndarray, "cells"]:
    """Information about the place in bit/spike, NaN for a silent cell.

    I = Σ p (λ/λ̄) log₂(λ/λ̄) over the visited bins, where p is the occupancy and λ̄ = Σ p λ; no term is clipped.

    Source: Skaggs, McNaughton, Gothard & Markus 1993, An information-theoretic approach to deciphering the
    hippocampal code, NIPS 5.
    """
    return information_per_spike(maps.occupancy[maps.visited], maps.patterns)


def information_per_spike(
    occupancy: Float[np.ndarray, "*cells bins"], rates: Float[np.ndarray, "cells bins"]
) -> Float[np.ndarray, "cells"]:
    """Information in bit/spike about bins that are visited so often, for all cells or for each."""
    part, gain = _gain(occupancy, rates)
    return np.asarray(np.sum(part * special.xlogy(gain, gain), axis=1) / np.log(2))


def sparsity(maps: RateMaps) -> Float[np.ndarray, "cells"]:
    """Part of the room that a cell fires in, λ̄² / Σ p λ² in (0, 1], NaN for a silent cell.

    Source: Skaggs, McNaughton, Wilson & Barnes 1996, Hippocampus 6.
    """
    part, gain = _gain(maps.occupancy[maps.visited], maps.patterns)
    return np.asarray(1 / np.sum(part * gain**2, axis=1))


def selectivity(maps: RateMaps) -> Float[np.ndarray, "cells"]:
    """Peak of the map over the mean rate, max λ / λ̄ ≥ 1, NaN for a silent cell.

    Source: Skaggs, McNaughton, Wilson & Barnes 1996, Hippocampus 6.
    """
    return np.asarray(_gain(maps.occupancy[maps.visited], maps.patterns)[1].max(axis=1))


def _gain(
    occupancy: Float[np.ndarray, "*cells bins"], rates: Float[np.ndarray, "cells bins"]
) -> tuple[Float[np.ndarray, "*cells bins"], Float[np.ndarray, "cells bins"]]:
    """Occupancy as a probability, and rates over their mean."""
    part = ratio(occupancy, occupancy.sum(axis=-1, keepdims=True))
    return part, ratio(rates, np.sum(part * rates, axis=1, keepdims=True))
