from collections.abc import Callable
from itertools import islice

import numpy as np
import pytest

from cogmap.cells.measures.autocorrelogram import autocorrelograms
from cogmap.cells.measures.fields import place_fields
from cogmap.cells.measures.grid_nulls import band_noise, shuffled_fields
from cogmap.cells.measures.gridness import lattice
from cogmap.cells.rates.maps import RateMaps, rate_maps


@pytest.fixture
def maps(wander: Callable, hexagonal: Callable, bump: Callable) -> RateMaps:
    positions, _ = wander(8000)
    # A hole in the room.
    positions = positions[np.hypot(*(positions - [1, 0]).T) > 0.4]
    rates = np.stack([10 * hexagonal(positions, 0.8), bump(positions, (-0.8, 0.3))], axis=1)
    return rate_maps(rates, positions, smoothing=0.08)


def test_band_noise_has_the_bands_of_the_cell_in_all_directions(maps: RateMaps) -> None:
    noise = list(islice(band_noise(maps, np.random.default_rng(0)), 40))
    assert all(np.array_equal(np.isnan(null.rates[0]), ~maps.visited) for null in noise)
    variance = np.mean([null.patterns.var(axis=1) for null in noise], axis=0)
    np.testing.assert_allclose(variance, maps.patterns.var(axis=1), rtol=0.25)
    # It is as wavy, and turned as it comes.
    found = [lattice(autocorrelograms(null)) for null in noise]
    assert np.nanmedian([each.spacing[0] for each in found]) == pytest.approx(8, rel=0.15)
    turns = np.array([each.orientation[0] for each in found])
    assert abs(np.nanmean(np.exp(6j * turns))) < 0.5


def test_fields_move_whole_and_keep_their_rates(maps: RateMaps) -> None:
    nulls = shuffled_fields(maps, place_fields(maps, threshold=0.5), np.random.default_rng(0))
    peaks = []
    for null in islice(nulls, 20):
        assert np.array_equal(np.isnan(null.rates[1]), ~maps.visited)
        # The highest peak stays in the room, and no other field covers it.
        np.testing.assert_array_equal(null.patterns.max(axis=1), maps.patterns.max(axis=1))
        peaks.append(null.places[null.patterns[1].argmax()])
        # A single field that was not cut by a wall is the same, elsewhere.
        inside = np.abs(peaks[-1]) < [0.8, 0.4]
        if inside.all() and np.hypot(*(peaks[-1] - [1, 0])) > 1:
            assert null.patterns[1].mean() == pytest.approx(maps.patterns[1].mean(), rel=0.15)
    assert np.std(peaks, axis=0).min() > 0.4
