import numpy as np
import pandas as pd
import pytest

from cogmap.errors import CogmapError
from cogmap.plots import plot_morph


def curves() -> pd.DataFrame:
    rows = [
        {"seed": seed, "blend": blend, "place": 2 * blend - 1 + 0.1 * seed, "heading": 0.0, "room": blend}
        for seed in (0, 1)
        for blend in (0.0, 0.5, 1.0)
    ]
    return pd.DataFrame(rows).assign(nowhere=0.0, confidence=1.0)


def test_a_thin_line_a_seed_and_a_thick_one_of_their_mean() -> None:
    left, _ = plot_morph(curves()).axes
    place = [line for line in left.lines if line.get_label() == "place cells"]
    np.testing.assert_allclose(place[0].get_ydata(), [-0.95, 0.05, 1.05])
    # the line at 0, and of place and heading two seeds and a mean each
    assert len(left.lines) == 7


def test_an_empty_table_is_refused() -> None:
    with pytest.raises(CogmapError, match="no blends to draw"):
        plot_morph(curves().iloc[:0])
