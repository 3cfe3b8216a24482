from collections.abc import Callable

import numpy as np
import pytest
from neurospatial.encoding._field_metrics import field_stability

from cogmap.cells.measures.stability import curve_stability, map_stability
from cogmap.cells.rates.bins import bin_edges
from cogmap.cells.rates.maps import rate_maps
from cogmap.cells.rates.spikes import poisson_spikes
from cogmap.cells.rates.tuning import tuning_curves


def test_agrees_with_neurospatial(wander: Callable) -> None:
    positions, headings = wander(1001)
    rates = np.random.default_rng(1).gamma(0.5, 2, (1001, 4))
    edges = bin_edges(positions)
    halves = slice(None, 501), slice(501, None)
    maps = [rate_maps(rates[half], positions[half], edges=edges).rates for half in halves]
    assert not np.array_equal(np.isnan(maps[0]), np.isnan(maps[1]))
    np.testing.assert_allclose(
        map_stability(rates, positions, edges),
        [field_stability(a.ravel(), b.ravel()) for a, b in zip(*maps, strict=True)],
    )
    curves = [tuning_curves(rates[half], headings[half]) for half in halves]
    np.testing.assert_allclose(
        curve_stability(rates, headings), [field_stability(a, b) for a, b in zip(*curves, strict=True)]
    )


def test_cells_that_keep_lose_and_turn_their_tuning(
    wander: Callable, bump: Callable, von_mises: Callable
) -> None:
    positions, headings = wander(12_000)
    late = np.arange(12_000) >= 6000
    place = [
        bump(positions),
        np.where(late, bump(positions, (-1.2, 0.8)), bump(positions, (1.2, -0.8))),
        np.full(12_000, 4.0),
    ]
    kept, moved, uniform = map_stability(np.stack(place, axis=1), positions, bin_edges(positions))
    assert kept > 0.995
    assert -0.3 < moved < 0
    assert np.isnan(uniform)
    direction = [von_mises(headings), von_mises(headings, np.where(late, 0.5, 0.5 + np.pi), 0.5)]
    kept, turned = curve_stability(np.stack(direction, axis=1), headings)
    assert kept > 0.995
    assert turned < -0.95


def test_chance_is_about_zero(wander: Callable) -> None:
    positions, headings = wander(6000)
    spikes = poisson_spikes(np.full((6000, 200), 3.0), np.random.default_rng(0)) / 0.3
    assert abs(curve_stability(spikes, headings).mean()) < 0.03
    assert abs(map_stability(spikes, positions, bin_edges(positions)).mean()) < 0.03


def test_views_outside_the_edges_are_left_out(wander: Callable, bump: Callable) -> None:
    positions, _ = wander(3000)
    # The first third of the views is outside.
    positions = positions[np.argsort(positions[:, 0] < 0.6, kind="stable")]
    inside = positions[:, 0] < 0.6
    edges = bin_edges(positions[inside])
    rates = bump(positions, (-0.5, 0.0))[:, None]
    np.testing.assert_array_equal(
        map_stability(rates, positions, edges), map_stability(rates[inside], positions[inside], edges)
    )


@pytest.mark.parametrize("views", [1, 2])
def test_too_few_views_tell_nothing(wander: Callable, views: int) -> None:
    positions, headings = wander(views)
    rates = np.arange(1.0, views + 1)[:, None]
    assert np.isnan(map_stability(rates, positions, bin_edges(positions))).all()
    assert np.isnan(curve_stability(rates, headings)).all()
