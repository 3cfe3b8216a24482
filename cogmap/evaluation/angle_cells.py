"""Cells of one angle: populations tuned to a phase, judged by the joints of a body."""

import numpy as np
from jaxtyping import Float

from cogmap.cells.measures.heading import LEAST_VECTOR
from cogmap.cells.rates.tuning import mean_vectors, tuning_curves

CELLS, CONCENTRATION = 60, 5.0
"""Of a population, and κ of its tuning to the phase, both as those of head-direction cells."""
MOST_OTHER = 0.25
"""Mean vector about another angle from which on a cell is tuned to that one, too."""


def share_of_one_angle(
    phase: Float[np.ndarray, "views"], own: Float[np.ndarray, "views"], other: Float[np.ndarray, "views"]
) -> float:
    """Tell which share of a population is tuned to one true angle and to no other.

    Cells prefer phases evenly around the circle. One passes whose mean vector (36 occupancy-normalised bins)
    is longer than .5 about its own angle and shorter than .25 about the other.

    Parameters
    ----------
    phase
        What the cells are tuned to, rad.
    own, other
        The true angles, rad.
    """
    preferred = np.linspace(-np.pi, np.pi, CELLS, endpoint=False)
    rates = 20.0 * np.exp(CONCENTRATION * (np.cos(phase[:, None] - preferred) - 1))
    length, beside = (np.abs(mean_vectors(tuning_curves(rates, angle))) for angle in (own, other))
    return float(((length > LEAST_VECTOR) & (beside < MOST_OTHER)).mean())
