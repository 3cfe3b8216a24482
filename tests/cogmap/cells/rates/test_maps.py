from collections.abc import Callable

import numpy as np
import pandas as pd
import pynapple as nap
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage
from spatial_maps import SpatialMap

from cogmap.cells.rates.bins import BinEdges, bin_edges
from cogmap.cells.rates.maps import rate_maps
from cogmap.errors import CogmapError


def test_agrees_with_a_histogram_smoothed_cell_by_cell(wander: Callable) -> None:
    positions, _ = wander(3000)
    rates = np.random.default_rng(1).random((3000, 4)).astype(np.float32)
    maps = rate_maps(rates, positions)
    y, x = maps.edges.y, maps.edges.x
    views, _, _ = np.histogram2d(positions[:, 1], positions[:, 0], bins=(y, x))
    np.testing.assert_array_equal(maps.occupancy, views)
    occupancy = ndimage.gaussian_filter(views, 1.5, mode="constant")
    for cell in range(4):
        spikes, _, _ = np.histogram2d(positions[:, 1], positions[:, 0], bins=(y, x), weights=rates[:, cell])
        expected = ndimage.gaussian_filter(spikes, 1.5, mode="constant") / occupancy
        np.testing.assert_allclose(maps[cell][maps.visited], expected[maps.visited])
    assert maps.visited[1:-1, 1:-1].all()


def test_agrees_with_spatial_maps(wander: Callable) -> None:
    positions, _ = wander(3000)
    times, counts = np.arange(3000.0), np.random.default_rng(0).poisson(1, 3000)
    maps = rate_maps(counts[:, None].astype(float), positions)
    peer = SpatialMap(smoothing=0.15, box_size=[3.6, 2.6], bin_size=0.1)
    expected = peer.rate_map(*(positions + np.array([1.8, 1.3])).T, times, np.repeat(times, counts))
    known = ~np.isnan(expected).T
    # It cuts its Gaussian off at 8 σ, ours ends at 4 σ.
    np.testing.assert_allclose(maps[0][known], expected.T[known], rtol=1e-3)


def test_agrees_with_pynapple(wander: Callable) -> None:
    positions, _ = wander(3000)
    times, counts = np.arange(3000.0), np.random.default_rng(0).poisson(1, (3000, 2))
    spikes = nap.TsGroup({cell: nap.Ts(np.repeat(times, counts[:, cell])) for cell in range(2)})
    maps = rate_maps(counts.astype(float), positions, smoothing=0.0)
    curves = nap.compute_tuning_curves(
        spikes, nap.TsdFrame(times, positions), bins=list(maps.edges), epochs=nap.IntervalSet(-0.5, 2999.5)
    )
    np.testing.assert_array_equal(maps.occupancy, curves.attrs["occupancy"].T)
    np.testing.assert_allclose(maps, curves.to_numpy().transpose(0, 2, 1))


def test_patterns_are_the_visited_bins_at_their_places(wander: Callable) -> None:
    positions, headings = wander(400)
    maps = rate_maps(np.stack([headings + 4, positions[:, 0] + 2], axis=1), positions, smoothing=0.0)
    index = maps.edges.bin_of(maps.places)
    assert len(index) == maps.visited.sum() < maps.visited.size
    np.testing.assert_array_equal(maps.patterns, maps.rates.reshape(2, -1)[:, index])
    np.testing.assert_allclose(maps.patterns[1] - 2, maps.places[:, 0], atol=0.05)


def test_width_of_a_gaussian_cell_grows_by_the_smoothing(bump: Callable) -> None:
    along = np.arange(-1.99, 2, 0.02)
    positions = np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)
    maps = rate_maps(bump(positions, (0.0, 0.0), 0.3)[:, None], positions)
    x, y = np.meshgrid(*maps.edges.centres)
    width = np.sqrt(0.3**2 + 0.15**2 + 0.1**2 / 12)
    expected = 10 * (0.3 / width) ** 2 * np.exp(-(x**2 + y**2) / (2 * width**2))
    np.testing.assert_allclose(maps[0], expected, atol=0.02)


def test_row_is_y_and_column_is_x() -> None:
    positions = np.array([[0.05, 0.05], [0.55, 0.05], [0.05, 0.25]])
    maps = rate_maps(np.diag([1.0, 2, 3]), positions, smoothing=0.0)
    assert maps.rates.shape == (3, 3, 6)
    assert [maps[0][0, 0], maps[1][0, 5], maps[2][2, 0]] == [1, 2, 3]
    assert np.count_nonzero(~np.isnan(maps[0])) == 3


def test_never_visited_is_nan() -> None:
    rng = np.random.default_rng(0)
    positions = rng.uniform(-1.3, 1.3, (5000, 2))
    positions = positions[np.hypot(*positions.T) > 0.6]
    maps = rate_maps(np.ones((len(positions), 1)), positions)
    x, y = np.meshgrid(*maps.edges.centres)
    assert np.isnan(maps[0][np.hypot(x, y) < 0.5]).all()
    np.testing.assert_allclose(maps[0][np.hypot(x, y) > 0.7], 1)
    np.testing.assert_array_equal(maps.visited, ~np.isnan(maps[0]))


def test_visited_bins_of_another_recording_are_filled(wander: Callable) -> None:
    positions, _ = wander(5000)
    edges = bin_edges(positions)
    away = positions[np.hypot(*positions.T) > 0.4]
    alone = rate_maps(np.ones((len(away), 1)), away, edges=edges)
    told = rate_maps(np.ones((len(away), 1)), away, edges=edges, visited=edges.visited(positions))
    assert np.isnan(alone[0]).any()
    np.testing.assert_allclose(told[0], 1)


def test_positions_outside_given_edges_are_left_out(wander: Callable) -> None:
    positions, _ = wander(2000)
    inside = np.abs(positions).max(axis=1) < 0.5
    edges = bin_edges(positions[inside])
    rates = np.random.default_rng(0).random((2000, 2))
    np.testing.assert_array_equal(
        rate_maps(rates, positions, edges=edges),
        rate_maps(rates[inside], positions[inside], edges=edges),
    )


@settings(deadline=None)
@given(st.floats(0.01, 100), st.integers(0, 2**32 - 1))
def test_constant_rate_stays_constant(rate: float, seed: int) -> None:
    positions = np.random.default_rng(seed).uniform(-0.5, 0.5, (50, 2))
    maps = rate_maps(np.full((50, 1), rate), positions)
    np.testing.assert_allclose(maps[0][maps.visited], rate)


def test_is_an_array_of_maps(wander: Callable) -> None:
    positions, headings = wander(100)
    maps = rate_maps(np.stack([headings + 4] * 3, axis=1), positions)
    assert np.asarray(maps).shape == (len(maps), *maps.edges.shape) == maps.rates.shape
    assert maps.bin_area == pytest.approx(0.01)


def test_bad_input_is_refused(wander: Callable) -> None:
    positions, _ = wander(10)
    rates = np.ones((10, 1))
    edges = bin_edges(positions)
    with pytest.raises(CogmapError, match="rates is not finite in 10"):
        rate_maps(rates * np.nan, positions)
    with pytest.raises(CogmapError, match="positions is not finite"):
        rate_maps(rates, positions * np.inf)
    with pytest.raises(CogmapError, match=r"down to -1 Hz"):
        rate_maps(-rates, positions)
    with pytest.raises(CogmapError, match="smoothing is -1"):
        rate_maps(rates, positions, smoothing=-1.0)
    with pytest.raises(CogmapError, match=r"not 0\.2 m apart"):
        rate_maps(rates, positions, 0.2, edges=edges)
    with pytest.raises(CogmapError, match=r"visited has shape \(1, 1\)"):
        rate_maps(rates, positions, edges=edges, visited=np.ones((1, 1), bool))
    with pytest.raises(CogmapError, match="no position is in a bin"):
        rate_maps(rates, positions, edges=BinEdges(edges.x + 100, edges.y))
    with pytest.raises(CogmapError, match="1 maps for 2 cells"):
        rate_maps(rates, positions).of_cells(2)


@pytest.mark.parametrize("kind", [np.ndarray.tolist, pd.DataFrame, torch.from_numpy])
def test_samples_may_be_lists_frames_and_tensors(kind: Callable, wander: Callable) -> None:
    positions, _ = wander(300)
    rates = np.random.default_rng(2).random((300, 2))
    visited = rate_maps(rates, positions).visited
    one, other = (
        rate_maps(rates, positions),
        rate_maps(kind(rates), kind(positions), visited=visited.tolist()),
    )
    np.testing.assert_array_equal(one.rates, other.rates)
