import numpy as np
import pandas as pd
import pytest

from cogmap.errors import CogmapError
from cogmap.plots import plot_cases

LABELS = {"sources": "odour sources", "noise": "noise of the nose"}


@pytest.fixture
def cases() -> pd.DataFrame:
    return pd.DataFrame(
        {
            "sources": [3, 1, 2, 3],
            "noise": [0.1, 0.1, 0.1, 0.3],
            "position_median_m": [0.04, 0.5, 0.1, 0.06],
            "heading_median_deg": [1.0, np.nan, 2.0, 1.5],
            "place_cells_passing": [1.0, 0.2, 0.6, 0.9],
            "trusted": [True, False, True, True],
        }
    )


def test_each_row_keeps_what_most_share(cases: pd.DataFrame) -> None:
    figure = plot_cases(cases, LABELS)
    above, below = np.reshape(figure.axes, (2, 3))
    line, doubtful = above[0].lines
    np.testing.assert_allclose(line.get_xydata(), [[1, 50], [2, 10], [3, 4]])
    np.testing.assert_allclose(doubtful.get_xydata(), [[1, 50]])
    assert doubtful.get_markerfacecolor() == "white"
    np.testing.assert_allclose(below[0].lines[0].get_xydata(), [[0.1, 4], [0.3, 6]])
    assert [axes.get_xlabel() for axes in (above[2], below[2])] == list(LABELS.values())
    assert above[1].get_title() == "noise of the nose: 0.1"
    assert len(above[2].lines) == 2


def test_doublings_are_equally_far(cases: pd.DataFrame) -> None:
    axes = plot_cases(cases, LABELS, doubling=True).axes[0]
    assert axes.get_xscale() == "log"
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["1", "2", "3"]


def test_one_column_alone_is_refused(cases: pd.DataFrame) -> None:
    with pytest.raises(CogmapError, match="1 columns are labelled"):
        plot_cases(cases, {"sources": "odour sources"})
