import numpy as np
import pandas as pd
import pytest

from cogmap.cells import autocorrelograms
from cogmap.cells.rates.bins import BinEdges
from cogmap.cells.rates.maps import RateMaps
from cogmap.errors import CogmapError
from cogmap.plots.cells.grid_cells import plot_grid_cells
from cogmap.plots.style import BAD, INK


@pytest.fixture
def maps() -> RateMaps:
    rates = np.random.default_rng(0).gamma(1, 3, (3, 12, 15))
    rates[:, 0, :3] = np.nan
    edges = BinEdges(0.1 * np.arange(16), 0.1 * np.arange(13))
    return RateMaps(rates, (~np.isnan(rates[0])).astype(float), edges)


@pytest.fixture
def statistics() -> pd.DataFrame:
    return pd.DataFrame(
        {"gridness": [-0.2, np.nan, 1.1], "spacing_m": [np.nan, np.nan, 0.5], "passing": [False, False, True]}
    )


def test_the_most_grid_like_come_first_each_over_its_autocorrelogram(
    maps: RateMaps, statistics: pd.DataFrame
) -> None:
    figure = plot_grid_cells(maps, statistics, 2)
    above, below = np.reshape(figure.axes[:4], (2, 2))
    correlograms = autocorrelograms(maps)
    for room, lags, cell in zip(above, below, (2, 0), strict=True):
        (drawn,), (correlated,) = room.collections, lags.collections
        np.testing.assert_allclose(drawn.get_array().filled(np.nan), maps[cell] / np.nanmax(maps[cell]))
        np.testing.assert_allclose(correlated.get_array().filled(np.nan), correlograms[cell])
    assert [axes.get_title() for axes in above] == ["1.10, 0.50 m", "−0.20, no lattice"]
    assert [axes.title.get_color() for axes in above] == [INK, BAD]
    np.testing.assert_allclose(correlated.get_coordinates()[[0, -1], [0, -1]], [[-1.45, -1.15], [1.45, 1.15]])
    assert figure.get_suptitle().startswith("2 of 3 cells as grid cells")


def test_bad_input_is_refused(maps: RateMaps, statistics: pd.DataFrame) -> None:
    with pytest.raises(CogmapError, match="count is 0"):
        plot_grid_cells(maps, statistics, 0)
    with pytest.raises(CogmapError, match="3 maps for 2 cells"):
        plot_grid_cells(maps, statistics.iloc[:2])
