import numpy as np
import pytest
from matplotlib.collections import PathCollection, QuadMesh

from cogmap.errors import CogmapError
from cogmap.plots.style import direction_colours
from cogmap.plots.truth.heading_errors import plot_compass

Views = tuple[np.ndarray, np.ndarray, np.ndarray]


@pytest.fixture
def views() -> Views:
    """Headings read 4° too far to the left in the right half of the room and 2° too little in the left."""
    rng = np.random.default_rng(0)
    positions = rng.uniform([-2, -1], [2, 1], (3000, 2))
    true = rng.uniform(-np.pi, np.pi, 3000)
    offset = np.deg2rad(np.where(positions[:, 0] > 0, 4.0, -2.0))
    return np.angle(np.exp(1j * (true + offset))), true, positions


def test_left_is_estimate_against_truth_in_cyclic_colours(views: Views) -> None:
    estimated, true, positions = views
    left = plot_compass(estimated, true + 2 * np.pi, positions).axes[0]
    (dots,) = [found for found in left.collections if isinstance(found, PathCollection)]
    np.testing.assert_allclose(dots.get_offsets(), np.rad2deg(np.stack([true, estimated], axis=1)))
    np.testing.assert_allclose(dots.get_facecolor(), direction_colours(estimated))
    assert left.get_xlabel() == "true heading (°)"
    assert left.get_ylabel() == "learnt heading, aligned (°)"
    assert left.get_aspect() == 1


def test_middle_counts_every_view_and_marks_median_and_95_percent(views: Views) -> None:
    estimated, true, positions = views
    estimated[:5] += np.pi / 2
    middle = plot_compass(estimated, true, positions).axes[1]
    assert sum(bar.get_height() for bar in middle.patches) == 3000
    size = np.rad2deg(np.abs(np.angle(np.exp(1j * (estimated - true)))))
    marks = [line.get_xdata()[0] for line in middle.lines]
    np.testing.assert_allclose(marks, np.percentile(size, [50, 95]))
    legend = middle.get_legend()
    names = [text.get_text() for text in legend.get_texts()]
    assert names == [f"median {marks[0]:.1f}°", f"95 % below {marks[1]:.1f}°"]
    assert middle.patches[-1].get_height() == 5
    assert legend.get_title().get_text() == "5 beyond 12°, in the last bin"
    assert middle.get_xlabel() == "size of the heading error (°)"
    assert middle.get_ylabel() == "views"


def test_right_is_the_signed_mean_error_centred_on_zero(views: Views) -> None:
    figure = plot_compass(*views)
    assert len(figure.axes) == 4
    right, bar = figure.axes[2:]
    (mesh,) = [found for found in right.collections if isinstance(found, QuadMesh)]
    error = mesh.get_array()
    assert error.shape == (10, 20)
    np.testing.assert_allclose(error[:, :10], -2)
    np.testing.assert_allclose(error[:, 10:], 4)
    low, high = mesh.get_clim()
    assert low == -high
    assert mesh.get_cmap().name == "RdBu_r"
    assert mesh.get_coordinates()[0, 0].tolist() == [-2, -1]
    assert (right.get_xlabel(), right.get_ylabel()) == ("x (m)", "y (m)")
    assert bar.get_ylabel() == "learnt − true heading (°)"


def test_the_mean_is_circular_and_unvisited_bins_are_empty() -> None:
    true = np.zeros(40)
    estimated = np.repeat([np.deg2rad(170), np.deg2rad(-170)], 20)
    positions = np.repeat([[0.1, 0.1], [0.1, 0.1], [0.5, 0.1], [0.1, 0.1]], 10, axis=0)
    mesh = plot_compass(estimated, true, positions).axes[2].collections[0]
    error = mesh.get_array()
    assert error.mask.tolist() == [[False, True, False]]
    np.testing.assert_allclose(error[0, 2], -170)
    np.testing.assert_allclose(abs(error[0, 0]), 176.7, atol=0.2)


def test_perfect_headings_can_be_drawn(views: Views) -> None:
    _, true, positions = views
    assert sum(bar.get_height() for bar in plot_compass(true, true, positions).axes[1].patches) == 3000


def test_bad_input_is_refused(views: Views) -> None:
    estimated, true, positions = views
    with pytest.raises(CogmapError, match="headings_estimated has shape"):
        plot_compass(estimated[:0], true[:0], positions[:0])
    estimated[3] = np.nan
    with pytest.raises(CogmapError, match="headings_estimated is not finite"):
        plot_compass(estimated, true, positions)
