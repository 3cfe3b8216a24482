"""Population vectors: the rates of all cells at once, as patterns to tell places by."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from cogmap.cells.measures.correlations import correlations, standardised
from cogmap.cells.rates.maps import RateMaps
from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, checked_array


def pattern_correlations(activity: AnyArray, patterns: AnyArray) -> Float[np.ndarray, "views bins"]:
    """Correlate the activity in each view with the mean pattern of each bin, over the cells.

    NaN where all cells fire alike, as when all are silent. `likeliest` gives the place or heading with the
    nearest pattern.

    Parameters
    ----------
    activity
        Rates or spikes, (views, cells).
    patterns
        `maps.patterns` of rate maps or tuning curves, learnt from other views, (cells, bins).

    Raises
    ------
    CogmapError
        For values that are not finite or shapes that do not fit.

    References
    ----------
    Wilson & McNaughton 1993, Dynamics of the hippocampal ensemble code for space, Science 261. Zhang et al.
    1998, J. Neurophysiol. 79 (template matching).
    """
    activity = checked_array("activity", activity, (None, None))
    patterns = checked_array("patterns", patterns, (activity.shape[1], None))
    return np.asarray(standardised(activity.astype(float)) @ standardised(patterns.T.astype(float)).T)


def population_vector_correlations(one: RateMaps, other: RateMaps) -> Float[np.ndarray, "ny nx"]:
    """Correlate, bin by bin, the population vectors of the same cells in two conditions.

    1 where the population is in the same state, about 0 where it has remapped, NaN where either was never
    visited.

    Raises
    ------
    CogmapError
        For maps of other cells or on other bins.

    References
    ----------
    Leutgeb et al. 2005, Independent codes for spatial and episodic memory in hippocampal neuronal ensembles,
    Science 309.
    """
    other.of_cells(len(one))
    if not all(a.shape == b.shape and np.allclose(a, b) for a, b in zip(one.edges, other.edges, strict=True)):
        raise CogmapError("the maps are on other bins; make both with the same edges")
    found: np.ndarray = correlations(one.rates.reshape(len(one), -1).T, other.rates.reshape(len(one), -1).T)
    return found.reshape(one.edges.shape)
