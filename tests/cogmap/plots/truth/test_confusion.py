import numpy as np
import pandas as pd
import pytest

from cogmap import CogmapError
from cogmap.plots import plot_confusion

XY = np.random.default_rng(0).uniform(-1, 1, (4000, 2))


def room(confused: np.ndarray) -> pd.DataFrame:
    return pd.DataFrame({"x_m": XY[:, 0], "y_m": XY[:, 1], "confused": confused})


def test_each_room_shows_where_views_are_confused() -> None:
    figure = plot_confusion({"half_mad": room(XY[:, 0] > 0), "sane": room(np.zeros(4000, bool))})
    first, second = (axes for axes in figure.axes if axes.get_title())
    assert first.get_title().startswith("half mad: ")
    assert second.get_title() == "sane: 0.0 % of 4,000 views confused"
    share = first.collections[0].get_array()
    np.testing.assert_allclose(share[:, 0], 0)
    np.testing.assert_allclose(share[:, -1], 1)
    assert first.collections[0].get_clim() == (0, 1)


def test_no_room_is_refused() -> None:
    with pytest.raises(CogmapError, match="no rooms"):
        plot_confusion({})
