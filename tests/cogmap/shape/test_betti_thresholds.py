import numpy as np
import pytest

from cogmap.shape import betti_thresholds as null

METRICS = {"geodesic": (1, 2), "euclidean": (0, 1, 2)}
TABLES = [(metric, dimension) for metric, dimensions in METRICS.items() for dimension in dimensions]


@pytest.mark.parametrize(("metric", "dimension"), TABLES)
def test_table_holds_what_is_simulated(metric: null.Metric, dimension: int) -> None:
    simulated = null._simulated(metric, dimension, 50, 25, null.NEIGHBOURS)
    assert null.threshold(metric, dimension, points=50, landmarks=25) == pytest.approx(simulated, abs=1e-4)


@pytest.mark.parametrize(("metric", "dimension"), TABLES)
def test_between_the_entries_lies_between(metric: null.Metric, dimension: int) -> None:
    corners = [
        null.threshold(metric, dimension, points=landmarks * crowd, landmarks=landmarks)
        for landmarks in (100, 200)
        for crowd in (8, 16)
    ]
    between = null.threshold(metric, dimension, points=1700, landmarks=150)
    assert min(corners) <= between <= max(corners)
    table = np.array(null._table()[metric][dimension])
    assert table.shape == (len(null.LANDMARKS[dimension]), len(null.CROWDS))
    assert corners[0] == table[2, 3]


@pytest.mark.parametrize("metric", ["geodesic", "euclidean"])
def test_more_points_deceive_less_and_more_landmarks_more(metric: null.Metric) -> None:
    crowds = [null.threshold(metric, 1, points=400 * crowd, landmarks=400) for crowd in null.CROWDS[1:]]
    assert (np.diff(crowds) < 0).all()
    counts = [null.threshold(metric, 1, points=4 * count, landmarks=count) for count in null.LANDMARKS[1]]
    assert (np.diff(counts) > 0).all()


@pytest.mark.parametrize(("dimension", "cube"), [(1, 2), (2, 3)])
def test_fresh_cubes_rarely_deceive(dimension: int, cube: int) -> None:
    limit = null.threshold("geodesic", dimension, points=800, landmarks=100)
    largest = [
        null.largest_ratios("geodesic", cube, 800, [(dimension, 100)], rng=np.random.default_rng([1, seed]))
        for seed in range(40)
    ]
    # 5 % or 1 % of 40, over a limit estimated from 100 cubes: 8 are a beta-binomial chance of 1 in 100.
    assert np.count_nonzero(np.array(largest) > limit) < 8
    assert np.median(largest) > 0.8 * limit


def test_outside_the_table_is_simulated() -> None:
    few = null.threshold("euclidean", 1, points=60, landmarks=15)
    assert few == null._simulated("euclidean", 1, 60, 15, 15)
    assert 1 < few < null.threshold("euclidean", 1, points=240, landmarks=60)


def test_fewer_neighbours_have_their_own_null() -> None:
    table = null.threshold("geodesic", 1, points=50, landmarks=25)
    assert null.threshold("geodesic", 1, points=50, landmarks=25, neighbours=40) == table
    assert null.threshold("geodesic", 1, points=50, landmarks=25, neighbours=5) != table
    straight = null.threshold("euclidean", 1, points=50, landmarks=25)
    assert null.threshold("euclidean", 1, points=50, landmarks=25, neighbours=5) == straight


def test_crowds_beyond_the_table_count_as_its_last() -> None:
    last = null.threshold("geodesic", 1, points=12_800, landmarks=400)
    assert null.threshold("geodesic", 1, points=170_000, landmarks=400) == last


def test_pieces_of_a_graph_need_no_threshold() -> None:
    assert null.threshold("geodesic", 0, points=1000, landmarks=400) == np.inf
