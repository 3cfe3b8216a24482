import numpy as np
import pytest
from matplotlib.collections import LineCollection, PathCollection

from cogmap.errors import CogmapError
from cogmap.plots.truth.position import plot_position

Views = tuple[np.ndarray, np.ndarray, np.ndarray]


@pytest.fixture
def views() -> Views:
    rng = np.random.default_rng(0)
    true = rng.uniform([-2, -1.5], [2, 1.5], (400, 2))
    return true + rng.normal(0, 0.04, true.shape), true, true + rng.normal(0, 0.15, true.shape)


def test_segments_go_from_truth_to_recall(views: Views) -> None:
    recalled, true, _ = views
    axes, _, bar = plot_position(recalled, true).axes
    (segments,) = [found for found in axes.collections if isinstance(found, LineCollection)]
    np.testing.assert_array_equal(segments.get_segments(), np.stack([true, recalled], axis=1))
    np.testing.assert_allclose(segments.get_array(), 100 * np.hypot(*(recalled - true).T))
    (dots,) = [found for found in axes.collections if isinstance(found, PathCollection)]
    np.testing.assert_array_equal(dots.get_offsets(), true)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (m)", "y (m)")
    assert axes.get_aspect() == 1
    assert bar.get_ylabel() == "position error (cm)"
    assert axes.get_title() == "true (dot) to recalled position, 400 of 400 views"


def test_of_many_views_some_are_drawn_evenly_and_all_are_counted() -> None:
    true = np.stack([np.arange(6000) / 1000, np.zeros(6000)], axis=1)
    recalled = true + np.array([0, 0.01])
    left, right, _ = plot_position(recalled, true).axes
    (segments,) = [found for found in left.collections if isinstance(found, LineCollection)]
    drawn = np.array(segments.get_segments())
    assert len(drawn) == 1500
    np.testing.assert_allclose(drawn[:, 0, 0], np.arange(1500) * 4 / 1000)
    assert right.get_title() == "6,000 views"


def test_distributions_of_recall_and_nose(views: Views) -> None:
    recalled, true, nose = views
    right = plot_position(recalled, true, nose).axes[1]
    curves = [line for line in right.lines if len(line.get_xdata()) > 100]
    marks = [line for line in right.lines if line.get_marker() == "o"]
    names = [text.get_text() for text in right.get_legend().get_texts()]
    assert len(curves) == len(marks) == len(names) == 2
    for found, curve, mark, name in zip((recalled, nose), curves, marks, names, strict=True):
        error = 100 * np.hypot(*(found - true).T)
        x, share = curve.get_data()
        np.testing.assert_allclose(np.unique(x[np.isfinite(x)]), np.unique(error))
        assert share[-1] == 1
        np.testing.assert_allclose(mark.get_xdata(), np.percentile(error, [50, 95]))
        assert f"median {np.median(error):.1f} cm" in name
    assert names[0].startswith("recalled from sight")
    assert names[1].startswith("raw nose")
    assert (right.get_xlabel(), right.get_ylabel()) == ("position error (cm)", "share of views")
    assert right.get_xlim()[1] > marks[1].get_xdata()[1]


def test_without_a_nose_there_is_one_curve(views: Views) -> None:
    recalled, true, _ = views
    assert len(plot_position(recalled, true).axes[1].get_legend().get_texts()) == 1


def test_perfect_recall_can_be_drawn(views: Views) -> None:
    _, true, _ = views
    assert "median 0.0 cm" in plot_position(true, true).axes[1].get_legend().get_texts()[0].get_text()


def test_bad_input_is_refused(views: Views) -> None:
    recalled, true, nose = views
    with pytest.raises(CogmapError, match="true has shape"):
        plot_position(recalled[:0], true[:0])
    nose[3] = np.nan
    with pytest.raises(CogmapError, match="nose is not finite"):
        plot_position(recalled, true, nose)
    recalled[0] = np.inf
    with pytest.raises(CogmapError, match="recalled is not finite"):
        plot_position(recalled, true)
