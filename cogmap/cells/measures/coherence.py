"""Spatial coherence: how smooth a rate map is by itself."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy import ndimage

from cogmap.cells.measures.correlations import correlations
from cogmap.cells.rates.maps import RateMaps
from cogmap.cells.rates.ratios import ratio


def coherence(maps: RateMaps) -> Float[np.ndarray, "cells"]:
    """Correlation over bins of the rate with the mean rate of the known ones of its eight neighbours.

    In [−1, 1], NaN for a constant map. Give maps without smoothing, which would make any cell coherent. The
    source reports Fisher's z = artanh r of it.

    Source: Muller & Kubie 1989, The firing of hippocampal place cells predicts the future position of freely
    moving rats, J. Neurosci. 9.
    """
    around = np.ones((1, 3, 3))
    around[0, 1, 1] = 0
    visited = maps.visited[None].astype(float)
    total, number = (
        ndimage.convolve(values, around, mode="constant") for values in (np.nan_to_num(maps.rates), visited)
    )
    mean = ratio(total, number)
    return correlations(maps.patterns, mean[:, maps.visited])
