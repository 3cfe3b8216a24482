import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_hex

from cogmap.errors import CogmapError
from cogmap.plots.cells.cell_types import plot_cell_types
from cogmap.plots.style import BAD, GOOD


@pytest.fixture
def cells() -> pd.DataFrame:
    rng = np.random.default_rng(0)
    return pd.DataFrame(
        {
            "population": ["seeing"] * 30 + ["smelling"] * 20,
            "spatial_information": rng.uniform(0, 3, 50),
            "spatial_information_beyond_heading": rng.uniform(0, 2, 50),
            "in_field_direction_vector": np.where(np.arange(50) % 7 == 0, np.nan, rng.uniform(0, 1, 50)),
            "mean_vector_length": rng.uniform(0, 1, 50),
            "place_passing": np.arange(50) % 2 == 0,
            "heading_passing": np.arange(50) < 10,
        }
    )


def test_every_cell_is_where_its_statistics_say_in_its_colour(cells: pd.DataFrame) -> None:
    figure = plot_cell_types(cells)
    above, below = np.reshape(figure.axes, (2, 2))
    for axes, key, information, kind in (
        (above[1], "in_field_direction_vector", "spatial_information", "place"),
        (below[1], "mean_vector_length", "spatial_information_beyond_heading", "heading"),
    ):
        mine = cells[cells["population"] == "smelling"]
        (dots,) = (found for found in axes.collections if len(found.get_offsets()) > 1)
        expected = mine[[key, information]].to_numpy()
        drawn = dots.get_offsets()
        assert np.array_equal(np.ma.getmaskarray(drawn).any(axis=1), np.isnan(expected).any(axis=1))
        np.testing.assert_allclose(np.ma.compress_rows(drawn), expected[~np.isnan(expected).any(axis=1)])
        colours = [to_hex(colour) for colour in dots.get_facecolors()]
        assert colours == [GOOD if passes else BAD for passes in mine[f"{kind}_passing"]]
    assert above[0].get_title() == "seeing\n50% place cells"
    assert below[0].get_title() == "seeing\n33% heading cells"


def test_no_cells_are_refused(cells: pd.DataFrame) -> None:
    with pytest.raises(CogmapError, match="no cells"):
        plot_cell_types(cells.iloc[:0])
