from collections.abc import Callable

import numpy as np
from neurospatial import Environment
from neurospatial.encoding._field_metrics import rate_map_coherence
from scipy import ndimage

from cogmap.cells.measures.coherence import coherence
from cogmap.cells.rates.bins import BinEdges
from cogmap.cells.rates.maps import RateMaps, rate_maps
from cogmap.cells.rates.spikes import poisson_spikes


def grid(rates: np.ndarray, visited: np.ndarray) -> RateMaps:
    edges = BinEdges(*(0.1 * np.arange(length + 1) for length in rates.shape[:0:-1]))
    return RateMaps(np.where(visited, rates, np.nan), visited.astype(float), edges)


def test_agrees_with_neurospatial_around_a_hole() -> None:
    rates = np.random.default_rng(0).gamma(1, 2, (5, 14, 18))
    rates[1:] = ndimage.gaussian_filter(rates[1:], (0, 0.7, 0.7))
    visited = np.ones((14, 18), dtype=bool)
    visited[5:9, 3:11] = visited[0, 4] = False
    maps = grid(rates, visited)
    # neurospatial's first axis is x.
    environment = Environment.from_grid_mask(visited.T, tuple(maps.edges))
    expected = [rate_map_coherence(rate.T[visited.T], environment) for rate in rates]
    np.testing.assert_allclose(coherence(maps), expected)


def test_a_ramp_away_from_borders_is_coherent_and_a_chessboard_the_reverse() -> None:
    y, x = np.mgrid[:12, :15]
    board = (-1.0) ** (x + y) + 1
    found = coherence(grid(np.stack([x + 2.0 * y, board, np.full(x.shape, 4.0)]), x >= 0))
    assert found[0] > 0.97
    # Inside, half of the eight neighbours of a square have its colour; along a border three of five have not.
    assert found[1] < -0.1
    assert np.isnan(found[2])


def test_a_bin_without_neighbours_is_left_out() -> None:
    rates = np.array([[[5.0, 0, 1, 2, 4], [0, 0, 1, 3, 3]]])
    visited = np.array([[True, False, True, True, True], [False, False, True, True, True]])
    np.testing.assert_allclose(
        coherence(grid(rates, visited)), coherence(grid(rates[:, :, 2:], visited[:, 2:]))
    )


def test_spikes_of_a_place_cell_cohere_and_those_of_a_uniform_cell_do_not(
    wander: Callable, bump: Callable
) -> None:
    positions, _ = wander(20_000)
    rates = np.stack([bump(positions), np.full(len(positions), 2.0)], axis=1)
    spikes = poisson_spikes(rates, np.random.default_rng(0), peak=None)
    place, uniform = coherence(rate_maps(spikes / 0.3, positions, smoothing=0.0))
    assert place > 0.8
    # 936 bins: chance has a standard deviation of about 1/√936.
    assert abs(uniform) < 0.12
