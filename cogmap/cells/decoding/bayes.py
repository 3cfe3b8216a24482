"""Bayesian decoding: what spikes say about where the animal is or looks."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy import special

from cogmap.cells.rates.spikes import SECONDS, check_seconds
from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, checked_array, checked_rates


def poisson_posterior(
    spikes: AnyArray,
    patterns: AnyArray,
    *,
    seconds: float = SECONDS,
    prior: AnyArray | None = None,
    faintest: float = 1e-3,
) -> Float[np.ndarray, "views bins"]:
    """Probability of each bin given the spikes of independent Poisson cells.

    P(bin | n) ∝ P(bin) Π λ_i(bin)^{n_i} e^{−λ_i(bin) T}. `likeliest(posterior, maps.places)` decodes place,
    `likeliest(posterior, heading_centres(36))` heading.

    Parameters
    ----------
    spikes
        How often each cell fired in each view, (views, cells).
    patterns
        λ in Hz: `maps.patterns` of rate maps or tuning curves, learnt from other views.
    seconds
        T, how long a view lasts.
    prior
        P(bin), in any unit; uniform by default. Occupancy makes rare places less likely.
    faintest
        No bin has a lower rate, Hz, so that one spike where a cell was never heard makes a bin unlikely, not
        impossible.

    Raises
    ------
    CogmapError
        For values that are negative or not finite, shapes that do not fit, a prior that excludes every bin.

    References
    ----------
    Zhang, Ginzburg, McNaughton & Sejnowski 1998, Interpreting neuronal population activity by reconstruction,
    J. Neurophysiol. 79.
    """
    spikes = checked_rates(spikes)
    patterns = checked_array("patterns", patterns, (spikes.shape[1], None))
    check_seconds(seconds)
    rates = np.maximum(patterns.astype(float), faintest)
    likelihood = spikes.astype(float) @ np.log(rates) - seconds * rates.sum(axis=0)
    if prior is not None:
        prior = checked_array("prior", prior, (patterns.shape[1],))
        if prior.min() < 0 or prior.max() <= 0:
            raise CogmapError("prior is negative or nowhere positive; give a probability to every bin")
        likelihood += special.xlogy(1, prior)
    return np.asarray(special.softmax(likelihood, axis=1))
