import numpy as np
import pytest
from scipy import stats

from cogmap.cells.rates.spikes import SECONDS, poisson_spikes
from cogmap.errors import CogmapError


def test_counts_have_the_poisson_distribution() -> None:
    counts = poisson_spikes(np.full((20_000, 1), 7.0), np.random.default_rng(0), peak=None, seconds=0.5)
    seen = np.bincount(counts[:, 0], minlength=13)
    expected = stats.poisson(3.5).pmf(np.arange(12))
    expected = np.append(expected, 1 - expected.sum())
    seen = np.append(seen[:12], seen[12:].sum())
    assert stats.chisquare(seen, 20_000 * expected).pvalue > 0.01


def test_every_cell_peaks_at_twenty_hertz() -> None:
    shape = np.array([[0.0, 0, 0], [1, 0, 50], [4, 0, 100]])
    rates = np.repeat(shape, 40_000, axis=0).astype(np.float32)
    spikes = poisson_spikes(rates, np.random.default_rng(0))
    measured = spikes.reshape(3, 40_000, 3).mean(axis=1) / SECONDS
    # Four standard errors of a mean rate of 20 Hz.
    error = 4 * np.sqrt(20 / (SECONDS * 40_000))
    np.testing.assert_allclose(measured, [[0, 0, 0], [5, 0, 10], [20, 0, 20]], atol=error)
    low = poisson_spikes(rates, np.random.default_rng(0), peak=2.0)
    assert low[:, 0].sum() == pytest.approx(spikes[:, 0].sum() / 10, rel=0.02)


def test_cells_and_views_are_independent() -> None:
    spikes = poisson_spikes(np.full((20_000, 2), 5.0), np.random.default_rng(0))
    for one, other in ((spikes[:, 0], spikes[:, 1]), (spikes[1:, 0], spikes[:-1, 0])):
        assert abs(np.corrcoef(one, other)[0, 1]) < 4 / np.sqrt(20_000)


def test_same_generator_same_spikes() -> None:
    rates = np.random.default_rng(0).random((50, 4))
    one, again, other = (poisson_spikes(rates, np.random.default_rng(seed)) for seed in (3, 3, 4))
    np.testing.assert_array_equal(one, again)
    assert (one != other).any()


def test_bad_input_is_refused() -> None:
    rng, rates = np.random.default_rng(0), np.ones((3, 2))
    with pytest.raises(CogmapError, match="down to -1 Hz"):
        poisson_spikes(-rates, rng)
    for peak in (0.0, np.nan, -1.0):
        with pytest.raises(CogmapError, match="peak is"):
            poisson_spikes(rates, rng, peak=peak)
    for seconds in (0.0, np.inf, -1.0):
        with pytest.raises(CogmapError, match="a view lasts"):
            poisson_spikes(rates, rng, seconds=seconds)
