import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from cogmap.cells.rates.bins import (
    BinEdges,
    bin_edges,
    heading_bin,
    heading_centres,
    means_by_bin,
    sums_by_bin,
)
from cogmap.errors import CogmapError


def test_edges_are_multiples_of_the_bin_around_the_positions() -> None:
    x, y = bin_edges(np.array([[-0.31, 0.05], [0.3, 0.151]]))
    np.testing.assert_allclose(x, [-0.4, -0.3, -0.2, -0.1, 0, 0.1, 0.2, 0.3], atol=1e-12)
    np.testing.assert_allclose(y, [0, 0.1, 0.2], atol=1e-12)


def test_a_single_point_on_an_edge_has_a_bin() -> None:
    point = np.array([[0.3, -0.7]])
    edges = bin_edges(point)
    assert edges.shape == (1, 1)
    assert edges.bin_of(point) == [0]


@settings(deadline=None)
@given(
    st.lists(st.tuples(st.integers(-400, 400), st.integers(-400, 400)), min_size=1, max_size=20),
    st.sampled_from([0.05, 0.1, 0.25]),
)
def test_every_position_is_in_the_bin_whose_edges_hold_it(points: list[tuple[int, int]], size: float) -> None:
    positions = np.array(points) * 0.01
    edges = bin_edges(positions, size)
    row, column = np.divmod(edges.bin_of(positions), edges.shape[1])
    for along, bins, index in ((positions[:, 0], edges.x, column), (positions[:, 1], edges.y, row)):
        assert (bins[index] - 1e-6 <= along).all()
        assert (along <= bins[index + 1] + 1e-6).all()


def test_bin_of_agrees_with_numpy() -> None:
    positions = np.random.default_rng(0).uniform([-1, 0], [1, 3], (500, 2))
    edges = bin_edges(positions)
    counts = np.bincount(edges.bin_of(positions), minlength=edges.shape[0] * edges.shape[1])
    expected, _, _ = np.histogram2d(positions[:, 1], positions[:, 0], bins=(edges.y, edges.x))
    np.testing.assert_array_equal(counts.reshape(edges.shape), expected)


def test_outside_is_no_bin() -> None:
    edges = bin_edges(np.array([[0.0, 0.0], [1.0, 1.0]]))
    outside = np.array([[-0.1, 0.5], [1.1, 0.5], [0.5, -0.1], [0.5, 1.1], [0.95, 0.05]])
    np.testing.assert_array_equal(edges.bin_of(outside), [-1, -1, -1, -1, 9])


def test_centres() -> None:
    x, y = BinEdges(np.array([0.0, 1, 2]), np.array([3.0, 4])).centres
    np.testing.assert_array_equal(x, [0.5, 1.5])
    np.testing.assert_array_equal(y, [3.5])


def test_visited_fills_chance_misses_and_nothing_else() -> None:
    edges = BinEdges(np.linspace(0, 2, 21), np.linspace(0, 2, 21))
    x, y = (along.ravel() for along in np.meshgrid(*edges.centres))
    centres = np.stack([x, y], axis=1)
    room = (np.hypot(x - 1, y - 1) > 0.35) & (x < 1.6)
    np.testing.assert_array_equal(edges.visited(centres[room]).ravel(), room)
    missed = room & ~np.isin(np.arange(400), [5, 10, 63, 64, 83, 84, 215, 393])
    np.testing.assert_array_equal(edges.visited(centres[missed]).ravel(), room)


def test_visited_by_five_thousand_views_is_the_whole_room() -> None:
    positions = np.random.default_rng(1).uniform([-1.8, -1.3], [1.8, 1.3], (5000, 2))
    edges = bin_edges(positions)
    counts = np.bincount(edges.bin_of(positions), minlength=36 * 26)
    assert (counts == 0).any()
    assert edges.visited(positions).all()


def test_heading_bins_agree_with_numpy_and_wrap() -> None:
    headings = np.random.default_rng(0).uniform(-np.pi, np.pi, 300)
    expected = np.digitize(headings, np.linspace(-np.pi, np.pi, 13)) - 1
    np.testing.assert_array_equal(heading_bin(headings, 12), expected)
    np.testing.assert_array_equal(heading_bin(np.array([-np.pi, np.pi]), 12), [0, 0])
    np.testing.assert_array_equal(heading_bin(np.float32([-np.pi, np.pi, 0.01]), 36) % 35, [0, 0, 18])


def test_heading_centres_are_the_middles_of_their_bins() -> None:
    np.testing.assert_array_equal(heading_bin(heading_centres(7), 7), np.arange(7))
    np.testing.assert_allclose(heading_centres(4), np.array([-3, -1, 1, 3]) * np.pi / 4)


def test_sums_and_means_agree_with_scipy() -> None:
    rng = np.random.default_rng(0)
    index, values = rng.integers(-1, 6, 100), rng.random((100, 3)).astype(np.float32)
    index[index == 4] = 5
    for function, name in ((sums_by_bin, "sum"), (means_by_bin, "mean")):
        expected, _, _ = stats.binned_statistic(index, values.T, name, bins=np.arange(-0.5, 6.5))
        np.testing.assert_allclose(function(index, 6, values), expected.T, rtol=1e-6)


def test_means_over_a_choice_of_views_per_cell() -> None:
    index = np.array([0, 0, 1, 1])
    values = np.array([[1.0, 1], [3, 3], [5, 5], [7, 7]])
    counted = np.array([[True, True], [True, False], [False, False], [True, False]])
    np.testing.assert_array_equal(means_by_bin(index, 2, values, counted), [[2, 1], [7, np.nan]])


def test_bad_input_is_refused() -> None:
    with pytest.raises(CogmapError, match="bin is 0"):
        bin_edges(np.zeros((1, 2)), 0.0)
    with pytest.raises(CogmapError, match="not finite"):
        bin_edges(np.array([[0.0, np.nan]]))
    with pytest.raises(CogmapError, match="2 heading bins"):
        heading_bin(np.zeros(1), 2)


@pytest.mark.parametrize(("size", "unit"), [((100, 100), "1000 by 1000"), ((640, 480), "6400 by 4800")])
def test_positions_in_centimetres_or_pixels_are_told(size: tuple[int, int], unit: str) -> None:
    positions = np.array([[0, 0], size])
    with pytest.raises(CogmapError, match=f"by {size[1]} make {unit} bins .* centimetres or pixels"):
        bin_edges(positions)
    assert max(bin_edges(positions, size[0] / 50).shape) == 50


def test_many_bins_are_made_for_many_views() -> None:
    corners = np.array([[0, 0], [6, 5]])
    assert bin_edges(np.tile(corners, (38_000, 1)), 0.02).shape == (250, 300)
    with pytest.raises(CogmapError, match="70000 positions spread over 6 by 5 make 300 by 250 bins"):
        bin_edges(np.tile(corners, (35_000, 1)), 0.02)
