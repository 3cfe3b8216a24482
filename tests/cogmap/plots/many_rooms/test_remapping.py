import numpy as np
import pandas as pd
import pytest

from cogmap.cells import RateMaps, bin_edges, rate_maps
from cogmap.errors import CogmapError
from cogmap.plots import plot_remapping


def maps(seed: int) -> RateMaps:
    rng = np.random.default_rng(seed)
    return rate_maps(
        rng.random((500, 12)), rng.uniform(-1, 1, (500, 2)), edges=bin_edges(np.array([(-1.0, -1), (1, 1)]))
    )


def test_maps_matrix_and_bars() -> None:
    rooms = {"study": maps(0), "wet_cellar": maps(1)}
    pairs = pd.DataFrame({"room": ["study"], "other_room": ["wet_cellar"], "correlation": [0.25]})
    changes = pd.DataFrame(
        {"change": ["nothing", "walls"], "remapping_index": [0.0, 0.9], "remapping": ["none", "global"]}
    )
    figure = plot_remapping(rooms, pairs, changes)
    left, right = figure.subfigs[1].axes[:2]
    np.testing.assert_allclose(left.images[0].get_array(), [[1, 0.25], [0.25, 1]])
    assert [bar.get_width() for bar in right.patches] == [0.0, 0.9]
    assert [text.get_text() for text in right.texts] == ["none", "global"]
    titles = [axes.get_title() for axes in figure.subfigs[0].axes]
    assert "wet\ncellar" in titles


def test_no_room_is_refused() -> None:
    with pytest.raises(CogmapError, match="no rooms to draw"):
        plot_remapping({}, pd.DataFrame(), pd.DataFrame())
