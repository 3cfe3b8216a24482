import numpy as np
import pytest
from matplotlib.collections import LineCollection

from cogmap.errors import CogmapError
from cogmap.plots.truth.metric_map import plot_metric_map


@pytest.fixture
def true() -> np.ndarray:
    x = np.arange(-10, 10) * 0.05 + 0.025
    return np.stack(np.meshgrid(x, x), axis=2).reshape(-1, 2)


def test_the_lattice_is_moved_by_the_mean_error(true: np.ndarray) -> None:
    left, right, bar = plot_metric_map(true + np.array([0.03, 0.04]), true).axes
    plain, moved = (found for found in left.collections if isinstance(found, LineCollection))
    ends = [np.array(found.get_segments()) for found in (plain, moved)]
    np.testing.assert_allclose(ends[1] - ends[0], np.broadcast_to([0.03, 0.04], ends[0].shape))
    np.testing.assert_allclose(np.linalg.norm(ends[0][:, 1] - ends[0][:, 0], axis=1), 0.2)
    np.testing.assert_allclose(moved.get_array(), 5)
    assert bar.get_ylabel() == "mean error (cm)"
    assert (left.get_xlabel(), left.get_ylabel()) == ("x (m)", "y (m)")
    assert right.get_xlabel() == "distance from the true position (cm)"
    legend = [text.get_text() for text in right.get_legend().get_texts()]
    assert legend == ["median 5.0 cm", "95 % below 5.0 cm"]


def test_no_link_crosses_what_was_not_visited(true: np.ndarray) -> None:
    around = true[np.abs(true).max(axis=1) > 0.2]
    left = plot_metric_map(around, around).axes[0]
    middle = [np.mean(link, axis=0) for found in left.collections for link in found.get_segments()]
    assert np.abs(middle).max(axis=1).min() > 0.2


def test_r2_and_outliers_are_told(true: np.ndarray) -> None:
    mapped = true.copy()
    mapped[0] += 3
    right = plot_metric_map(mapped, true).axes[1]
    explained = 1 - 18 / np.square(true - true.mean(axis=0)).sum()
    assert right.get_title() == f"400 views, R² {explained:.4f}"
    assert right.get_legend().get_title().get_text().startswith("1 beyond")
    assert sum(bar.get_height() for bar in right.patches) == 400


def test_bad_input_is_refused(true: np.ndarray) -> None:
    with pytest.raises(CogmapError, match="true has shape"):
        plot_metric_map(true[:0], true[:0])
    with pytest.raises(CogmapError, match="mapped is not finite"):
        plot_metric_map(true * np.nan, true)
