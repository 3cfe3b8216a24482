from collections.abc import Callable

import numpy as np
import pynapple as nap
import spatial_maps
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from neurospatial.encoding import _metrics as neurospatial
from scipy import integrate, stats

from cogmap.cells.measures.information import selectivity, sparsity, spatial_information
from cogmap.cells.rates.maps import RateMaps, rate_maps


def lattice(half: float) -> np.ndarray:
    along = np.arange(-half + 0.01, half, 0.02)
    return np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)


def test_gaussian_cell_has_the_information_of_its_integral(bump: Callable) -> None:
    positions = lattice(2)
    maps = rate_maps(bump(positions, (0.0, 0.0), 0.3)[:, None], positions)
    variance = 0.3**2 + 0.15**2 + 0.1**2 / 12

    def rate(x: float, y: float) -> float:
        return np.exp(-(x**2 + y**2) / (2 * variance))

    def mean(function: Callable[[float], float]) -> float:
        return integrate.dblquad(lambda x, y: function(rate(x, y)), -2, 2, -2, 2)[0] / 16

    average = mean(lambda r: r)
    information = mean(lambda r: r / average * np.log2(r / average))
    np.testing.assert_allclose(spatial_information(maps), information, rtol=2e-3)
    np.testing.assert_allclose(sparsity(maps), average**2 / mean(lambda r: r**2), rtol=2e-3)
    # The four bins next to the centre are centred 5 cm off along x and y.
    np.testing.assert_allclose(selectivity(maps), rate(0.05, 0.05) / average, rtol=2e-3)


def test_is_the_divergence_of_spikes_from_occupancy(wander: Callable) -> None:
    positions, _ = wander(800)
    rates = np.random.default_rng(2).gamma(0.3, 5, (800, 5))
    maps = rate_maps(rates, positions)
    p = maps.occupancy[maps.visited]
    for cell, information in enumerate(spatial_information(maps)):
        np.testing.assert_allclose(information, stats.entropy(p * maps[cell][maps.visited], p, base=2))


def test_agrees_with_pynapple_neurospatial_and_spatial_maps(wander: Callable) -> None:
    positions, _ = wander(800)
    rates = np.random.default_rng(2).gamma(0.3, 5, (800, 5))
    rates[positions[:, 0] > 0] = 0
    maps = rate_maps(rates, positions, smoothing=0.0)
    information, part, peak = (measure(maps) for measure in (spatial_information, sparsity, selectivity))
    curves = xr.DataArray(
        maps.rates,
        dims=("unit", "y", "x"),
        coords={"unit": np.arange(5)},
        attrs={
            "occupancy": maps.occupancy,
            "rates": np.nansum(maps.rates * maps.occupancy, axis=(1, 2)) / 800,
        },
    )
    np.testing.assert_allclose(information, nap.compute_mutual_information(curves)["bits/spike"])
    p = maps.occupancy / maps.occupancy.sum()
    for cell, rate in enumerate(maps.rates):
        trusted = (
            neurospatial.spatial_information(rate.ravel(), p.ravel()),
            neurospatial.sparsity(rate.ravel(), p.ravel()),
            neurospatial.selectivity(rate.ravel(), p.ravel()),
        )
        np.testing.assert_allclose((information[cell], part[cell], peak[cell]), trusted)
        # It takes the logarithm of zero.
        some = np.where(rate > 0, rate, np.nan)
        with np.errstate(divide="ignore", invalid="ignore"):
            trusted = (
                spatial_maps.information_specificity(some, p),
                spatial_maps.sparsity(some, p),
                spatial_maps.selectivity(some, p),
            )
        np.testing.assert_allclose((information[cell], part[cell], peak[cell]), trusted)


def test_firing_in_one_of_n_bins_is_log_n() -> None:
    positions = np.stack(np.meshgrid(np.arange(4) + 0.5, np.arange(8) + 0.5), axis=-1).reshape(-1, 2)
    maps = rate_maps(np.eye(32), positions, 1.0, 0.0)
    np.testing.assert_allclose(spatial_information(maps), 5)
    np.testing.assert_allclose(sparsity(maps), 1 / 32)
    np.testing.assert_allclose(selectivity(maps), 32)


def test_uniform_cell_tells_nothing_and_a_silent_one_is_unknown(wander: Callable) -> None:
    positions, _ = wander(500)
    maps = rate_maps(np.stack([np.full(500, 3.0), np.zeros(500)], axis=1), positions)
    np.testing.assert_allclose(spatial_information(maps), [0, np.nan], atol=1e-12)
    np.testing.assert_allclose(sparsity(maps), [1, np.nan])
    np.testing.assert_allclose(selectivity(maps), [1, np.nan])


@settings(deadline=None)
@given(st.floats(1e-3, 1e3), st.integers(0, 2**32 - 1))
def test_scale_of_the_rate_does_not_matter(scale: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    rates, positions = rng.random((60, 3)), rng.uniform(-0.5, 0.5, (60, 2))
    once, scaled = rate_maps(rates, positions), rate_maps(scale * rates, positions)
    for statistic in (spatial_information, sparsity, selectivity):
        np.testing.assert_allclose(statistic(scaled), statistic(once), atol=1e-12)


def test_bins_never_visited_do_not_count() -> None:
    maps = rate_maps(np.eye(2), np.array([[0.5, 0.5], [5.5, 0.5]]), 1.0, 0.0)
    assert isinstance(maps, RateMaps)
    np.testing.assert_allclose(spatial_information(maps), 1)
