import numpy as np
import pandas as pd
import pytest

from cogmap.errors import CogmapError
from cogmap.plots import plot_forgetting

COURSE = pd.DataFrame(
    {
        "rooms": [1, 2],
        "heading_median_deg": [1.0, 1.2],
        "position_median_m": [0.04, 0.05],
        "recognised": [1.0, 0.99],
        "correlation": [1.0, 0.98],
    }
)


def test_errors_are_drawn_over_rooms_in_degrees_and_centimetres() -> None:
    figure = plot_forgetting(COURSE)
    heading, position, alike = figure.axes
    np.testing.assert_allclose(heading.lines[0].get_ydata(), [1.0, 1.2])
    np.testing.assert_allclose(position.lines[0].get_ydata(), [4.0, 5.0])
    np.testing.assert_allclose(alike.lines[1].get_ydata(), [1.0, 0.99])


def test_an_empty_table_is_refused() -> None:
    with pytest.raises(CogmapError, match="no rooms to draw"):
        plot_forgetting(COURSE.iloc[:0])
