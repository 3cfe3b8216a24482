import numpy as np
import pytest
from matplotlib.collections import LineCollection

from cogmap.cells import Decoded
from cogmap.plots.truth.decoding import plot_decoding


@pytest.fixture
def decoded() -> Decoded:
    rng = np.random.default_rng(0)
    true, faced = rng.uniform([0, 0], [2, 1], (1000, 2)), rng.uniform(-np.pi, np.pi, 1000)
    return Decoded(np.arange(1000.0), true, true + rng.normal(0, 0.05, true.shape), faced, faced + 0.1)


def test_positions_and_headings_beside_the_true_ones(decoded: Decoded) -> None:
    left, middle, right, bar = plot_decoding(decoded).axes
    (segments,) = [found for found in left.collections if isinstance(found, LineCollection)]
    chosen = np.arange(800) * 1000 // 800
    ends = np.stack([decoded.positions, decoded.decoded_positions], axis=1)[chosen]
    np.testing.assert_array_equal(segments.get_segments(), ends)
    error = 100 * np.linalg.norm(decoded.decoded_positions - decoded.positions, axis=1)
    x, share = middle.lines[0].get_data()
    np.testing.assert_allclose(np.unique(x[np.isfinite(x)]), np.unique(error))
    assert share[-1] == 1
    told = [text.get_text() for text in middle.get_legend().get_texts()]
    assert told[0] == f"cells: median {np.median(error):.1f} cm"
    chance = 100 * decoded.figures["chance_position_median_m"]
    assert told[1] == f"chance: median {chance:.1f} cm"
    assert middle.get_title() == "1,000 windows"
    assert right.get_title() == "median error 5.7°"
    assert bar.get_ylabel() == "position error (cm)"


def test_without_headings_there_are_two_panels(decoded: Decoded) -> None:
    blind = decoded._replace(headings=None, decoded_headings=None)
    assert [axes.get_xlabel() for axes in plot_decoding(blind).axes[:2]] == ["x (m)", "position error (cm)"]
    assert len(plot_decoding(blind).axes) == 3  # with the colour bar
