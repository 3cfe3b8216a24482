"""Bayesian decoding: what spikes say about where the animal is or looks."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy import special

from cogmap.cells.rates.spikes import SECONDS, check_seconds
from cogmap.errors import CogmapError
from cogmap.inputs import AnyArray, checked_array, checked_rates

PAIRS = 4_000_000
"""Of place and direction, that are weighed at once."""


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


class JointPosterior(NamedTuple):
    """What spikes say of place and heading together, each for itself in the end."""

    place: Float[np.ndarray, "views bins"]
    heading: Float[np.ndarray, "views directions"]


def joint_posterior(
    spikes: AnyArray,
    rates: AnyArray,
    gains: AnyArray,
    *,
    seconds: float = SECONDS,
    faintest: float = 1e-3,
) -> JointPosterior:
    """Probability of each place and of each direction given the spikes of cells that are tuned to both.

    P(x, θ | n) ∝ Π (p_i(x) d_i(θ))^{n_i} exp(−T Σ p_i(x) d_i(θ)), summed over θ for places, over x for
    directions. A head-direction cell tells of place what it says of direction where the animal happened to
    look; `poisson_posterior` takes it at its word.

    Parameters
    ----------
    spikes
        How often each cell fired in each view, (views, cells).
    rates, gains
        p in Hz and d, of mean 1, of the same cells, as `place_by_direction` factorises their rates.
    seconds
        T, how long a view lasts.
    faintest
        Hz; no p is lower, and no d lower than this share.

    Raises
    ------
    CogmapError
        For values that are negative or not finite, shapes that do not fit.
    """
    spikes = checked_rates(spikes)
    of_place = checked_array("rates", rates, (spikes.shape[1], None))
    of_heading = checked_array("gains", gains, (spikes.shape[1], None))
    check_seconds(seconds)
    p, d = np.maximum(of_place.astype(float), faintest), np.maximum(of_heading.astype(float), faintest)
    expected = seconds * (p.T @ d)
    by_place, by_heading = spikes @ np.log(p), spikes @ np.log(d)
    places, headings = np.empty_like(by_place), np.empty_like(by_heading)
    for views in np.array_split(np.arange(len(spikes)), -(-len(spikes) * expected.size // PAIRS)):
        scores = by_place[views, :, None] + by_heading[views, None, :] - expected
        scores -= scores.max(axis=(1, 2), keepdims=True)
        np.exp(scores, out=scores)
        places[views], headings[views] = scores.sum(axis=2), scores.sum(axis=1)
    return JointPosterior(*(part / part.sum(axis=1, keepdims=True) for part in (places, headings)))
