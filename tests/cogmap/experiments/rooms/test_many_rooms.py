import numpy as np
import pytest

from cogmap.cells import bin_edges, rate_maps
from cogmap.experiments.rooms.many_rooms import active, population_correlation, rate_change

CELLS, VIEWS = 30, 4000


def maps(seed: int, gain: float = 1.0):
    """Gaussian fields at places that the seed draws."""
    rng = np.random.default_rng(seed)
    centres = rng.uniform(-1, 1, (CELLS, 2))
    xy = np.random.default_rng(100).uniform(-1, 1, (VIEWS, 2))
    rates = gain * 10 * np.exp(-np.square(xy[:, None] - centres).sum(axis=2) / 0.1)
    return rate_maps(rates, xy, edges=bin_edges(np.array([(-1.0, -1.0), (1.0, 1.0)])))


def test_the_same_fields_correlate_and_others_do_not() -> None:
    assert population_correlation(maps(0), maps(0)) == pytest.approx(1.0)
    assert abs(population_correlation(maps(0), maps(1))) < 0.15


def test_a_population_that_fires_more_has_the_same_fields_and_other_rates() -> None:
    assert population_correlation(maps(0), maps(0, 3.0)) == pytest.approx(1.0)
    assert rate_change(maps(0), maps(0, 3.0)) == pytest.approx(0.5)
    assert rate_change(maps(0), maps(0)) == 0


def test_cells_that_hardly_fire_are_not_active() -> None:
    assert active(maps(0)).mean() == 1
    assert active(maps(0, 0.01)).mean() == 0
