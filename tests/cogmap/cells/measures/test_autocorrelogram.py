import numpy as np

from cogmap.cells.measures.autocorrelogram import autocorrelograms
from cogmap.cells.rates.bins import BinEdges
from cogmap.cells.rates.maps import RateMaps


def test_agrees_with_numpys_correlation_of_what_overlaps_around_a_hole() -> None:
    rates = np.random.default_rng(0).gamma(1, 100, (3, 7, 9))
    rates[:, 2:4, 5] = rates[:, 0, 0] = np.nan
    maps = RateMaps(rates, (~np.isnan(rates[0])).astype(float), BinEdges(np.arange(10.0), np.arange(8.0)))
    found = autocorrelograms(maps)
    assert found.shape == (3, 13, 17)
    np.testing.assert_allclose(found[:, 6, 8], 1)
    for dy, dx in np.ndindex(13, 17):
        y, x = np.mgrid[:7, :9]
        there_y, there_x = y + dy - 6, x + dx - 8
        inside = (there_y >= 0) & (there_y < 7) & (there_x >= 0) & (there_x < 9)
        for cell, rate in enumerate(rates):
            one, other = rate[inside], rate[there_y[inside], there_x[inside]]
            both = ~np.isnan(one + other)
            expected = np.corrcoef(one[both], other[both])[0, 1] if both.sum() >= 20 else np.nan
            np.testing.assert_allclose(found[cell, dy, dx], expected, atol=1e-9)


def test_constant_and_silent_maps_have_none() -> None:
    edges = BinEdges(np.arange(9.0), np.arange(7.0))
    maps = RateMaps(np.stack([np.zeros((6, 8)), np.full((6, 8), 0.1)]), np.ones((6, 8)), edges)
    assert np.isnan(autocorrelograms(maps)).all()
