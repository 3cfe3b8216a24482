from collections.abc import Callable

import numpy as np
import pandas as pd
import pynapple as nap
import pytest
from astropy.stats import circmoment
from hypothesis import given, settings
from hypothesis import strategies as st
from neurospatial.encoding.directional import DirectionalRateResult
from scipy import special, stats

from cogmap.cells.rates.tuning import mean_vectors, tuning_curves, tuning_widths
from cogmap.errors import CogmapError

CENTRES = -np.pi + (np.arange(36) + 0.5) * np.pi / 18


def test_curves_agree_with_scipy(wander: Callable) -> None:
    _, headings = wander(1000)
    rates = np.random.default_rng(0).random((1000, 3)).astype(np.float32)
    expected, _, _ = stats.binned_statistic(headings, rates.T, "mean", bins=36, range=(-np.pi, np.pi))
    np.testing.assert_allclose(tuning_curves(rates, headings), expected, rtol=1e-6)


def test_curves_agree_with_pynapple(wander: Callable) -> None:
    _, headings = wander(1000)
    times, counts = np.arange(1000.0), np.random.default_rng(0).poisson(1, (1000, 2))
    spikes = nap.TsGroup({cell: nap.Ts(np.repeat(times, counts[:, cell])) for cell in range(2)})
    expected = nap.compute_tuning_curves(
        spikes,
        nap.Tsd(times, headings),
        bins=36,
        range=(-np.pi, np.pi),
        epochs=nap.IntervalSet(-0.5, 999.5),
    )
    np.testing.assert_allclose(tuning_curves(counts.astype(float), headings), expected)


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
    np.testing.assert_allclose((np.angle(vector), abs(vector)), circmoment(CENTRES, weights=counts))


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
    np.testing.assert_array_equal(np.isnan(mean_vectors(curves)), [False, True])


def test_empty_bins_take_the_first_harmonic_of_the_others() -> None:
    harmonic = 2 + np.cos(CENTRES - 0.7)
    curves = np.stack([harmonic, np.full(36, 3.0), 10 * np.exp(5 * (np.cos(CENTRES - 2) - 1))])
    curves[:, 5:11] = curves[1, 24:] = np.nan
    flat, vector = np.abs(mean_vectors(curves))[[1, 0]]
    assert flat == pytest.approx(0, abs=1e-12)
    assert vector == pytest.approx(0.25)
    # No rate is below zero, and a direction away from the gap is found as without it.
    full = mean_vectors(np.where(np.isnan(curves), 0.0, curves))[2]
    np.testing.assert_allclose(mean_vectors(curves)[2], full, atol=0.03)


def test_what_bins_on_one_side_do_not_tell_counts_as_a_direction() -> None:
    curve = np.full((1, 12), np.nan)
    curve[0, :3] = 4.0
    assert np.abs(mean_vectors(curve)) > 0.25


def peer_width(curve: np.ndarray) -> float:
    """Twice neurospatial's half-width."""
    known = ~np.isnan(curve)
    return 2 * DirectionalRateResult(curve, known.astype(float), CENTRES, np.pi / 18, None).tuning_width()


def test_width_agrees_with_neurospatial() -> None:
    rng = np.random.default_rng(0)
    curves = rng.gamma(1, 0.3, (50, 36)) + np.exp(3 * np.cos(CENTRES - rng.uniform(-np.pi, np.pi, (50, 1))))
    curves[:, [3, 17, 18, 30]] = np.nan
    np.testing.assert_allclose(tuning_widths(curves), [peer_width(curve) for curve in curves])


@pytest.mark.parametrize("kappa", [0.5, 2.0, 8.0])
def test_von_mises_cell_has_its_width(kappa: float) -> None:
    preferred = np.linspace(-np.pi, np.pi, 50)[:, None]
    curves = np.exp(kappa * np.cos(CENTRES - preferred))
    expected = 2 * np.arccos(1 - np.log(2) / kappa)
    # The middle of a bin is up to 5° off the peak.
    np.testing.assert_allclose(tuning_widths(curves), expected, atol=np.deg2rad(1.5))


def test_widths_of_square_flat_and_silent_cells() -> None:
    square = np.where(np.abs(CENTRES - CENTRES[2]) < 0.6, 8.0, 0.0)
    square[-1] = 8.0
    shallow = 2 + np.cos(CENTRES)
    lone = np.eye(36)[20]
    found = tuning_widths(np.stack([square, shallow, np.full(36, 3.0), np.zeros(36), lone]))
    # Seven bins are high, from half a bin before the first to half a bin after the last.
    np.testing.assert_allclose(np.rad2deg(found), [70, 360 * (1 - 1 / 3), np.nan, np.nan, 10], atol=1.0)
    assert np.isnan(tuning_widths(np.full((2, 36), np.nan))).all()


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


def test_headings_in_degrees_are_refused() -> None:
    headings = np.arange(0.0, 360.0, 5.0)
    rates = np.ones((72, 2))
    with pytest.raises(CogmapError, match=r"look like degrees; give numpy\.deg2rad\(headings\)"):
        tuning_curves(rates, headings)
    expected = tuning_curves(rates, np.deg2rad(headings))
    np.testing.assert_array_equal(tuning_curves(rates.tolist(), pd.Series(np.deg2rad(headings))), expected)


def test_curves_may_be_lists_and_frames() -> None:
    curves = np.array([[1.0, 4, 2, np.nan], [2, 1, 1, 5]])
    for measure in (mean_vectors, tuning_widths):
        np.testing.assert_array_equal(measure(pd.DataFrame(curves)), measure(curves))
        np.testing.assert_array_equal(measure(curves.tolist()), measure(curves))
