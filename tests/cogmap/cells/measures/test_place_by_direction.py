from collections.abc import Callable

import numpy as np
from sklearn.linear_model import PoissonRegressor

from cogmap.cells.measures.information import information_per_spike, spatial_information
from cogmap.cells.measures.place_by_direction import PlaceByDirection, place_by_direction
from cogmap.cells.rates.bins import bin_edges, heading_bin
from cogmap.cells.rates.maps import rate_maps
from cogmap.cells.rates.tuning import mean_vectors

Samples = tuple[np.ndarray, np.ndarray]


def apart(rates: np.ndarray, hall: Samples) -> PlaceByDirection:
    maps = rate_maps(rates, hall[0])
    return place_by_direction(rates, *hall, maps, np.broadcast_to(maps.visited, maps.rates.shape), bins=36)


def test_agrees_with_sklearns_poisson_regression_on_place_and_direction(wander: Callable) -> None:
    positions, headings = wander(600)
    edges = bin_edges(positions, 1.0)
    place, direction = edges.bin_of(positions), heading_bin(headings, 6)
    rates = np.random.default_rng(0).gamma(1.0, 1 + place / 3 + 4 * (direction == 2))[:, None]
    maps = rate_maps(rates, positions, 1.0, 0.0, edges=edges)
    found = place_by_direction(
        rates,
        positions,
        headings,
        maps,
        np.broadcast_to(maps.visited, (1, *edges.shape)),
        bins=6,
        smoothing=0.0,
    )
    dummies = np.concatenate([np.eye(edges.shape[0] * edges.shape[1])[place], np.eye(6)[direction]], axis=1)
    model = PoissonRegressor(alpha=1e-10, fit_intercept=False, tol=1e-10, solver="newton-cholesky")
    trusted = model.fit(dummies, rates[:, 0]).predict(dummies)
    factors = found.rates[0, place] * found.gains[0, direction]
    np.testing.assert_allclose(factors, trusted, rtol=1e-4)
    np.testing.assert_allclose(found.gains.mean(axis=1), 1)


def test_directions_tell_nothing_of_the_place_however_few_the_views(
    hall: Samples, von_mises: Callable
) -> None:
    preferred = np.linspace(-np.pi, np.pi, 20)
    rates = von_mises(hall[1][:, None], preferred, 5.0)
    assert spatial_information(rate_maps(rates, hall[0])).min() > 0.3
    found = apart(rates, hall)
    assert information_per_spike(found.exposure, found.rates).max() < 0.01
    turned = np.angle(mean_vectors(found.gains) * np.exp(-1j * preferred))
    np.testing.assert_allclose(turned, 0, atol=0.05)


def test_what_is_known_of_the_place_is_kept(hall: Samples, von_mises: Callable) -> None:
    placed = np.exp(1.5 * np.sin(2 * hall[0][:, :1]))
    (known,) = information_per_spike(np.ones(len(placed)), placed.T)
    found = apart(placed * von_mises(hall[1][:, None], np.linspace(-np.pi, np.pi, 20), 5.0), hall)
    np.testing.assert_allclose(information_per_spike(found.exposure, found.rates), known, rtol=0.2)


def test_a_silent_cell_has_no_gain(hall: Samples) -> None:
    found = apart(np.zeros((2500, 1)), hall)
    assert np.isnan(found.gains).all()
    assert not found.rates.any()
