from collections.abc import Callable

import numpy as np
import pytest
from astropy.stats import rayleightest
from hypothesis import given, settings
from hypothesis import strategies as st
from neurospatial.stats.circular import rayleigh_test as its_test
from scipy import special, stats

from cogmap.cells.measures.rayleigh import rayleigh_test
from cogmap.cells.rates.spikes import poisson_spikes
from cogmap.errors import CogmapError


@settings(deadline=None)
@given(st.integers(3, 300), st.floats(0, 1), st.integers(0, 2**32 - 1))
def test_agrees_with_astropy_and_neurospatial(views: int, rate: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    headings = rng.vonmises(1.0, 0.3, views)
    spikes = rng.poisson(rate, (views, 2))
    spikes[:3] += 1
    z, p = rayleigh_test(spikes, headings, bins=None)
    for cell in range(2):
        directions = np.repeat(headings, spikes[:, cell])
        np.testing.assert_allclose(p[cell], np.clip(rayleightest(directions), 0, 1), atol=1e-12)
        np.testing.assert_allclose((z[cell], p[cell]), its_test(directions), atol=1e-12)


@pytest.mark.parametrize("spikes", [7, 49, 50])
def test_the_bracket_is_for_fewer_than_fifty_spikes_and_p_is_never_negative(spikes: int) -> None:
    headings = np.random.default_rng(0).vonmises(1.0, 0.3, spikes)
    for where in (headings, np.full(spikes, 0.5)):
        p = rayleigh_test(np.ones((spikes, 1)), where, bins=None).p_value[0]
        np.testing.assert_allclose(p, np.clip(rayleightest(where), 0, 1), rtol=1e-12)
    assert (rayleightest(np.full(spikes, 0.5)) < 0) == (spikes == 7)


def test_a_single_spike_is_no_evidence() -> None:
    expected_spikes = np.array([[0.01, 0.0, 1.0, 1.01], [0, 0.5, 0, 0]])
    z, p = rayleigh_test(expected_spikes, np.array([0.3, 2.0]))
    np.testing.assert_array_equal(np.isnan(z), [True, True, True, False])
    np.testing.assert_array_equal(np.isnan(p), np.isnan(z))


def test_even_looking_weighs_nothing(von_mises: Callable) -> None:
    headings = np.tile(np.linspace(-np.pi, np.pi, 360, endpoint=False) + 1e-3, 3)
    spikes = np.random.default_rng(0).poisson(von_mises(headings)[:, None] / 50)
    np.testing.assert_allclose(rayleigh_test(spikes, headings), rayleigh_test(spikes, headings, bins=None))


def test_von_mises_cell_has_its_z(von_mises: Callable) -> None:
    headings = np.linspace(-np.pi, np.pi, 36_000, endpoint=False)
    spikes = von_mises(headings, 0.7, 0.5)[:, None] / 4000
    resultant = special.iv(1, 0.5) / special.iv(0, 0.5)
    z, p = rayleigh_test(spikes, headings)
    np.testing.assert_allclose(z, spikes.sum() * resultant**2, rtol=1e-3)
    np.testing.assert_allclose(p, np.exp(-z))


def test_p_is_uniform_for_cells_without_direction_however_uneven_the_looking() -> None:
    rng = np.random.default_rng(0)
    headings = rng.vonmises(1.0, 0.8, 3000)
    spikes = poisson_spikes(np.ones((3000, 1000)), rng, peak=0.5)
    assert stats.kstest(rayleigh_test(spikes, headings).p_value, "uniform").pvalue > 0.01
    assert rayleigh_test(spikes, headings, bins=None).p_value.max() < 1e-6


def test_uniform_cell_is_uniform_and_a_silent_one_unknown(wander: Callable) -> None:
    _, headings = wander(2000)
    # The mean direction inside a bin is not quite its middle.
    z, p = rayleigh_test(np.tile([2.0, 0.0], (2000, 1)), headings)
    np.testing.assert_allclose(z, [0, np.nan], atol=1e-2)
    np.testing.assert_allclose(p, [1, np.nan], atol=1e-2)


def test_bad_input_is_refused() -> None:
    with pytest.raises(CogmapError, match="headings is not finite"):
        rayleigh_test(np.ones((3, 1)), np.full(3, np.nan))
    with pytest.raises(CogmapError, match="down to -1"):
        rayleigh_test(-np.ones((3, 1)), np.zeros(3))
    with pytest.raises(CogmapError, match="2 heading bins"):
        rayleigh_test(np.ones((3, 1)), np.zeros(3), 2)
