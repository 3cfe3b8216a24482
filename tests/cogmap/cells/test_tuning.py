from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import special, stats

from cogmap.cells.tuning import mean_vectors, tuning_curves
from cogmap.errors import CogmapError

CENTRES = -np.pi + (np.arange(36) + 0.5) * np.pi / 18


def test_curves_agree_with_scipy(wander: Callable) -> None:
    _, headings = wander(1000)
    rates = np.random.default_rng(0).random((1000, 3)).astype(np.float32)
    expected, _, _ = stats.binned_statistic(headings, rates.T, "mean", bins=36, range=(-np.pi, np.pi))
    np.testing.assert_allclose(tuning_curves(rates, headings), expected, rtol=1e-6)


@pytest.mark.parametrize("kappa", [0.5, 2.0, 8.0])
def test_von_mises_cell_has_its_vector(von_mises: Callable, kappa: float) -> None:
    headings = np.linspace(-np.pi, np.pi, 36_000, endpoint=False)
    vector = mean_vectors(tuning_curves(von_mises(headings, -2.0, kappa)[:, None], headings))[0]
    np.testing.assert_allclose(abs(vector), special.iv(1, kappa) / special.iv(0, kappa), rtol=2e-3)
    np.testing.assert_allclose(np.angle(vector), -2.0, atol=1e-3)


def test_direction_of_curves_agrees_with_scipy() -> None:
    counts = np.random.default_rng(0).integers(0, 9, 36)
    vector = mean_vectors(counts[None].astype(float))[0]
    directions = np.repeat(CENTRES, counts)
    np.testing.assert_allclose(np.angle(vector), stats.circmean(directions, np.pi, -np.pi))
    np.testing.assert_allclose(1 - abs(vector), stats.circvar(directions))


def test_uneven_looking_does_not_make_a_direction() -> None:
    rng = np.random.default_rng(0)
    headings = rng.vonmises(1.0, 0.8, 5000)
    vectors = mean_vectors(tuning_curves(np.full((5000, 1), 4.0), headings))
    np.testing.assert_allclose(np.abs(vectors), 0, atol=1e-12)


def test_empty_bins_are_unknown_and_silent_cells_have_no_direction() -> None:
    headings = np.array([0.1, 0.1, 2.0])
    curves = tuning_curves(np.array([[1.0, 0], [3, 0], [0, 0]]), headings)
    assert np.isnan(curves).sum() == 2 * 34
    np.testing.assert_array_equal(curves[0][~np.isnan(curves[0])], [2, 0])
    np.testing.assert_allclose(np.abs(mean_vectors(curves)), [1, np.nan])


@settings(deadline=None)
@given(st.integers(0, 35), st.integers(0, 2**32 - 1))
def test_preferred_direction_turns_with_the_cell(steps: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    # Away from the borders of bins, where rounding may change the bin.
    headings = rng.choice(CENTRES, 200) + rng.uniform(-0.08, 0.08, 200)
    rates = np.exp(2 * np.cos(headings - rng.uniform(-np.pi, np.pi, (3, 1)))).T
    turn = steps * np.pi / 18
    turned = np.angle(np.exp(1j * (headings + turn)))
    expected = mean_vectors(tuning_curves(rates, headings)) * np.exp(1j * turn)
    np.testing.assert_allclose(mean_vectors(tuning_curves(rates, turned)), expected, atol=1e-9)


def test_bad_input_is_refused() -> None:
    with pytest.raises(CogmapError, match="headings is not finite"):
        tuning_curves(np.ones((2, 1)), np.array([0.0, np.nan]))
    with pytest.raises(CogmapError, match="rates is not finite"):
        tuning_curves(np.full((2, 1), np.inf), np.zeros(2))
    with pytest.raises(CogmapError, match="1 heading bins"):
        tuning_curves(np.ones((2, 1)), np.zeros(2), 1)
