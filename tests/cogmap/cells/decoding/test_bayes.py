from collections.abc import Callable

import numpy as np
import pynapple as nap
import pytest
import xarray as xr
from neurospatial.decoding.likelihood import log_poisson_likelihood
from scipy import special, stats

from cogmap.cells.decoding.bayes import joint_posterior, poisson_posterior
from cogmap.cells.decoding.decoders import likeliest
from cogmap.cells.rates.bins import heading_centres
from cogmap.cells.rates.maps import rate_maps
from cogmap.cells.rates.spikes import poisson_spikes
from cogmap.cells.rates.tuning import tuning_curves
from cogmap.errors import CogmapError


@pytest.fixture
def patterns() -> np.ndarray:
    return np.random.default_rng(0).gamma(1, 6, (5, 11)) + 0.1


@pytest.fixture
def spikes(patterns: np.ndarray) -> np.ndarray:
    return np.random.default_rng(1).poisson(0.25 * patterns[:, np.arange(40) % 11].T)


def test_agrees_with_pynapple(patterns: np.ndarray, spikes: np.ndarray) -> None:
    where = np.linspace(0.05, 1.05, 11)
    occupancy = np.arange(1.0, 12)
    curves = xr.DataArray(
        patterns,
        dims=("unit", "place"),
        coords={"unit": np.arange(5), "place": where},
        attrs={"occupancy": occupancy},
    )
    times = 0.125 + 0.25 * np.arange(40)
    counts = nap.TsdFrame(times, spikes, columns=np.arange(5), time_support=nap.IntervalSet(0, 10))
    for prior in (None, occupancy):
        decoded, expected = nap.decode_bayes(
            curves, counts, nap.IntervalSet(0, 10), 0.25, uniform_prior=prior is None
        )
        posterior = poisson_posterior(spikes, patterns, seconds=0.25, prior=prior)
        np.testing.assert_allclose(posterior, expected.values, rtol=1e-6)
        np.testing.assert_allclose(likeliest(posterior, where), decoded.values)


def test_agrees_with_neurospatial_and_with_scipys_distribution(
    patterns: np.ndarray, spikes: np.ndarray
) -> None:
    posterior = poisson_posterior(spikes, patterns, seconds=0.25)
    expected = special.softmax(log_poisson_likelihood(spikes, patterns, 0.25), axis=1)
    np.testing.assert_allclose(posterior, expected, rtol=1e-6)
    chance = stats.poisson(0.25 * patterns).logpmf(spikes[:, :, None]).sum(axis=1)
    np.testing.assert_allclose(posterior, special.softmax(chance, axis=1))


def test_place_and_heading_from_spikes(wander: Callable, bump: Callable, von_mises: Callable) -> None:
    positions, headings = wander(12_000)
    learnt, fresh = slice(None, 10_000), slice(10_000, None)
    centres = np.stack(np.meshgrid(np.linspace(-1.8, 1.8, 13), np.linspace(-1.3, 1.3, 9)), -1).reshape(-1, 2)
    rng = np.random.default_rng(0)

    place = poisson_spikes(np.stack([bump(positions, tuple(c)) for c in centres], axis=1), rng)
    maps = rate_maps(place[learnt] / 0.3, positions[learnt], smoothing=0.05)
    decoded = likeliest(poisson_posterior(place[fresh], maps.patterns), maps.places)
    away = np.linalg.norm(decoded - positions[fresh], axis=1)
    # Fisher's bound: a spike from a field of width σ tells σ/√1 along each axis.
    spikes_per_view = place[fresh].sum(axis=1).mean()
    bound = 0.3 / np.sqrt(spikes_per_view)
    assert bound < np.sqrt(np.mean(away**2) / 2) < 1.35 * bound

    preferred = np.linspace(-np.pi, np.pi, 60, endpoint=False)
    heading = poisson_spikes(von_mises(headings[:, None], preferred), rng)
    curves = tuning_curves(heading[learnt] / 0.3, headings[learnt])
    looked = likeliest(poisson_posterior(heading[fresh], curves), heading_centres(36))
    turn = np.angle(np.exp(1j * (looked - headings[fresh])))
    bound = 1 / np.sqrt(heading[fresh].sum(axis=1).mean() * 4 * special.iv(1, 4) / special.iv(0, 4))
    assert bound < np.std(turn) < 1.35 * bound


def test_no_spikes_leave_the_prior_and_what_silence_says(patterns: np.ndarray) -> None:
    silence = np.zeros((1, 5), dtype=int)
    prior = np.arange(11.0)
    posterior = poisson_posterior(silence, patterns, seconds=0.1, prior=prior)[0]
    expected = prior * np.exp(-0.1 * patterns.sum(axis=0))
    np.testing.assert_allclose(posterior, expected / expected.sum())
    assert posterior[0] == 0


@pytest.mark.parametrize("faintest", [1e-3, 0.1])
def test_one_stray_spike_does_not_make_a_place_impossible(faintest: float) -> None:
    patterns = np.array([[0.0, 20], [20, 0]])
    posterior = poisson_posterior(np.array([[1, 3], [1, 1]]), patterns, faintest=faintest)
    odds = (20 / faintest) ** 2
    np.testing.assert_allclose(posterior[0], [odds / (1 + odds), 1 / (1 + odds)])
    np.testing.assert_allclose(posterior[1], 0.5)


def test_bad_input_is_refused(patterns: np.ndarray, spikes: np.ndarray) -> None:
    with pytest.raises(CogmapError, match="patterns is not finite"):
        poisson_posterior(spikes, patterns * np.nan)
    with pytest.raises(CogmapError, match="down to -"):
        poisson_posterior(-spikes, patterns)
    with pytest.raises(CogmapError, match="a view lasts 0"):
        poisson_posterior(spikes, patterns, seconds=0.0)
    for prior in (np.zeros(11), -np.ones(11)):
        with pytest.raises(CogmapError, match="prior is negative or nowhere positive"):
            poisson_posterior(spikes, patterns, prior=prior)


def test_place_and_direction_together_are_every_pair_of_them_added_up() -> None:
    rng = np.random.default_rng(0)
    rates, gains = rng.gamma(1, 8, (20, 15)), rng.gamma(2, 0.5, (20, 12))
    spikes = rng.poisson(2, (50, 20))
    pairs = np.maximum(rates, 1e-3)[:, :, None] * np.maximum(gains, 1e-3)[:, None, :]
    every = poisson_posterior(spikes, pairs.reshape(20, -1), seconds=0.3, faintest=1e-9).reshape(50, 15, 12)
    found = joint_posterior(spikes, rates, gains, seconds=0.3)
    np.testing.assert_allclose(found.place, every.sum(axis=2), rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(found.heading, every.sum(axis=1), rtol=1e-9, atol=1e-15)


def test_cells_without_a_direction_tell_of_places_as_ever() -> None:
    rng = np.random.default_rng(1)
    rates, spikes = rng.gamma(1, 8, (20, 15)), rng.poisson(2, (50, 20))
    found = joint_posterior(spikes, rates, np.ones((20, 12)), seconds=0.5)
    np.testing.assert_allclose(found.place, poisson_posterior(spikes, rates, seconds=0.5), rtol=1e-9)
    np.testing.assert_allclose(found.heading, 1 / 12)


def test_many_fast_cells_do_not_overflow() -> None:
    rng = np.random.default_rng(2)
    rates, gains = rng.gamma(1, 40, (1000, 30)), rng.gamma(2, 0.5, (1000, 12))
    true = rng.integers(30, size=40), rng.integers(12, size=40)
    found = joint_posterior(rng.poisson(rates[:, true[0]].T * gains[:, true[1]].T), rates, gains, seconds=1.0)
    np.testing.assert_array_equal(found.place.argmax(axis=1), true[0])
    np.testing.assert_array_equal(found.heading.argmax(axis=1), true[1])


def test_what_cannot_be_decoded_together() -> None:
    with pytest.raises(CogmapError, match="gains is not finite"):
        joint_posterior(np.ones((2, 3)), np.ones((3, 5)), np.full((3, 12), np.nan))
    with pytest.raises(CogmapError, match="never negative"):
        joint_posterior(-np.ones((2, 3)), np.ones((3, 5)), np.ones((3, 12)))
