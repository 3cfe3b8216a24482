from collections.abc import Callable

import numpy as np
import pynapple as nap
import pytest
import spatial_maps.stats
import xarray as xr
from neurospatial.encoding.population import population_vector_correlation
from scipy.spatial.distance import cdist

from cogmap.cells.decoding.decoders import likeliest
from cogmap.cells.decoding.patterns import pattern_correlations, population_vector_correlations
from cogmap.cells.rates.bins import bin_edges, heading_centres
from cogmap.cells.rates.maps import rate_maps
from cogmap.cells.rates.spikes import poisson_spikes
from cogmap.cells.rates.tuning import tuning_curves
from cogmap.errors import CogmapError


def test_agrees_with_scipy_and_pynapple() -> None:
    rng = np.random.default_rng(0)
    activity, patterns = rng.poisson(3, (30, 6)), rng.gamma(1, 6, (6, 9))
    found = pattern_correlations(activity, patterns)
    np.testing.assert_allclose(1 - found, cdist(activity, patterns.T, "correlation"), atol=1e-12)
    where = np.linspace(0, 2, 9)
    curves = xr.DataArray(patterns, dims=("unit", "place"), coords={"unit": np.arange(6), "place": where})
    support = nap.IntervalSet(0, 30)
    counts = nap.TsdFrame(np.arange(30) + 0.5, activity, columns=np.arange(6), time_support=support)
    decoded, _ = nap.decode_template(curves, counts, support, 1.0)
    np.testing.assert_array_equal(likeliest(found, where), decoded.values)


def test_place_and_heading_from_the_nearest_pattern(
    wander: Callable, bump: Callable, von_mises: Callable
) -> None:
    positions, headings = wander(6000)
    learnt, fresh = slice(None, 5000), slice(5000, None)
    rng = np.random.default_rng(0)
    centres = rng.uniform([-1.8, -1.3], [1.8, 1.3], (120, 2))
    place = np.stack([bump(positions, tuple(centre)) for centre in centres], axis=1)
    maps = rate_maps(place[learnt], positions[learnt], smoothing=0.05)
    decoded = likeliest(pattern_correlations(place[fresh], maps.patterns), maps.places)
    # A bin's middle is 3.8 cm away in the mean.
    assert np.linalg.norm(decoded - positions[fresh], axis=1).mean() < 0.05
    spikes = poisson_spikes(place[fresh], rng)
    noisy = likeliest(pattern_correlations(spikes, maps.patterns), maps.places)
    assert np.median(np.linalg.norm(noisy - positions[fresh], axis=1)) < 0.15

    heading = von_mises(headings[:, None], np.linspace(-3, 3, 40))
    curves = tuning_curves(heading[learnt], headings[learnt])
    looked = likeliest(pattern_correlations(heading[fresh], curves), heading_centres(36))
    assert np.abs(np.angle(np.exp(1j * (looked - headings[fresh])))).max() < np.deg2rad(7.5)


def test_silence_is_like_nothing() -> None:
    found = pattern_correlations(np.array([[0, 0, 0], [1, 0, 2]]), np.array([[1.0, 3], [2, 3], [4, 3]]))
    np.testing.assert_array_equal(np.isnan(found), [[True, True], [False, True]])


def test_population_vectors_agree_with_spatial_maps_and_neurospatial(wander: Callable) -> None:
    positions, _ = wander(400)
    rates = np.random.default_rng(0).gamma(0.5, 3, (2, 400, 7))
    edges = bin_edges(positions)
    halves = positions[:, 0] < 0.8, positions[:, 0] > -0.8
    maps = [
        rate_maps(each[half], positions[half], edges=edges) for each, half in zip(rates, halves, strict=True)
    ]
    found = population_vector_correlations(*maps)
    both = maps[0].visited & maps[1].visited
    np.testing.assert_array_equal(np.isnan(found), ~both)
    vectors = np.concatenate([each.rates[:, both].T for each in maps])
    among = population_vector_correlation(vectors)
    np.testing.assert_allclose(found[both], np.diagonal(among, both.sum()))
    filled = [np.nan_to_num(each.rates, nan=1.0) for each in maps]
    with np.errstate(divide="ignore", invalid="ignore"):
        _, trusted = spatial_maps.stats.population_vector_correlation(*filled, return_corr_coeff_map=True)
    np.testing.assert_allclose(found[both], trusted[both])


def test_the_same_population_is_the_same_and_a_remapped_one_is_not(wander: Callable, bump: Callable) -> None:
    positions, _ = wander(3000)
    rng = np.random.default_rng(0)
    centres = rng.uniform([-1.8, -1.3], [1.8, 1.3], (100, 2))
    rates = np.stack([bump(positions, tuple(centre)) for centre in centres], axis=1)
    maps = rate_maps(rates, positions)
    remapped = rate_maps(rates[:, rng.permutation(100)], positions)
    np.testing.assert_allclose(population_vector_correlations(maps, maps), np.where(maps.visited, 1, np.nan))
    assert abs(np.nanmean(population_vector_correlations(maps, remapped))) < 0.05


def test_bad_input_is_refused(wander: Callable) -> None:
    positions, _ = wander(50)
    maps = rate_maps(np.ones((50, 2)), positions)
    with pytest.raises(CogmapError, match="1 maps for 2 cells"):
        population_vector_correlations(maps, rate_maps(np.ones((50, 1)), positions))
    for others in (positions + 1, positions[:3]):
        with pytest.raises(CogmapError, match="on other bins"):
            population_vector_correlations(maps, rate_maps(np.ones((len(others), 2)), others))
    with pytest.raises(CogmapError, match="activity is not finite"):
        pattern_correlations(np.full((3, 2), np.nan), np.ones((2, 4)))
    with pytest.raises(CogmapError, match="patterns is not finite"):
        pattern_correlations(np.ones((3, 2)), np.full((2, 4), np.nan))
