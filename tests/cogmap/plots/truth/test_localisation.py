import numpy as np
import pandas as pd
import pytest

from cogmap import CogmapError
from cogmap.plots import plot_localisation

ERRORS = np.arange(1, 101) / 100


def errors(count: int = 100) -> pd.DataFrame:
    """Up to 1 m and 2° where interpolated, four times that of the nearest view."""
    some = ERRORS[:count]
    return pd.DataFrame(
        {
            "position_error_m": some,
            "heading_error_deg": 2 * some,
            "nearest_position_error_m": 4 * some,
            "nearest_heading_error_deg": 8 * some,
        }
    )


def test_curves_are_the_shares_of_views_below_each_error() -> None:
    left, right = plot_localisation(errors()).axes
    for axes, scales in ((left, (100, 400)), (right, (2, 8))):
        assert axes.get_xscale() == "log"
        for line, scale in zip(axes.lines[::2], scales, strict=True):
            x, y = line.get_data()
            np.testing.assert_allclose(x[1:], scale * ERRORS)
            np.testing.assert_allclose(y[1:], ERRORS)
            assert y[0] == 0


def test_axes_and_legends_have_units() -> None:
    left, right = plot_localisation(errors()).axes
    assert left.get_xlabel() == "position error (cm)"
    assert left.get_ylabel() == "share of views"
    assert right.get_xlabel() == "heading error (°)"
    assert left.get_title() == "100 views"
    said = [[text.get_text() for text in axes.get_legend().get_texts()] for axes in (left, right)]
    assert said == [
        [
            "interpolated: median 50.5 cm, 95 % below 95 cm",
            "nearest view: median 202 cm, 95 % below 380 cm",
        ],
        ["interpolated: median 1.01°, 95 % below 1.9°", "nearest view: median 4.04°, 95 % below 7.6°"],
    ]


def test_views_without_a_place_are_left_out_and_no_error_is_drawn_as_a_tiny_one() -> None:
    table = errors()
    table.loc[3:, "position_error_m"] = np.nan
    table.loc[0, "heading_error_deg"] = 0.0
    left, right = plot_localisation(table).axes
    assert left.get_title() == "3 views"
    np.testing.assert_allclose(left.lines[0].get_xdata()[1:], [1, 2, 3])
    np.testing.assert_allclose(right.lines[0].get_xdata()[1:], [1e-3, 0.04, 0.06])


def test_no_views_are_refused() -> None:
    with pytest.raises(CogmapError, match="no view has a place"):
        plot_localisation(errors(0))
    with pytest.raises(CogmapError, match="no view has a place"):
        plot_localisation(errors() * np.nan)
