import numpy as np
import pytest

from cogmap.shape import betti_thresholds as null

KINDS: dict[str, tuple[null.Metric, int, tuple[int, ...]]] = {
    "geodesic_15": ("geodesic", 15, (1, 2)),
    "geodesic_25": ("geodesic", 25, (1, 2)),
    "euclidean": ("euclidean", 15, (0, 1, 2)),
}
TABLES = [(kind, dimension) for kind, (*_, dimensions) in KINDS.items() for dimension in dimensions]


@pytest.mark.parametrize("kind", KINDS)
def test_table_holds_what_is_simulated(kind: str) -> None:
    metric, neighbours, dimensions = KINDS[kind]
    sizes = [(dimension, 25) for dimension in dimensions]
    simulated = null._worst_quantiles(metric, 50, sizes, null.CLOUDS, neighbours)
    found = [
        null.threshold(metric, dimension, points=50, landmarks=25, neighbours=neighbours)
        for dimension in dimensions
    ]
    np.testing.assert_allclose(found, simulated, atol=1e-4)


@pytest.mark.parametrize(("kind", "dimension"), TABLES)
def test_between_the_entries_lies_between(kind: str, dimension: int) -> None:
    metric, neighbours, _ = KINDS[kind]
    corners = [
        null.threshold(
            metric, dimension, points=landmarks * crowd, landmarks=landmarks, neighbours=neighbours
        )
        for landmarks in (100, 200)
        for crowd in (8, 16)
    ]
    between = null.threshold(metric, dimension, points=1700, landmarks=150, neighbours=neighbours)
    assert min(corners) <= between <= max(corners)
    table = np.array(null._table()[kind][dimension])
    assert table.shape == (len(null.LANDMARKS[dimension]), len(null.CROWDS))
    assert corners[0] == table[2, 3]


@pytest.mark.parametrize("kind", KINDS)
def test_more_points_deceive_less_and_more_landmarks_more(kind: str) -> None:
    metric, neighbours, _ = KINDS[kind]
    crowds = [
        null.threshold(metric, 1, points=400 * crowd, landmarks=400, neighbours=neighbours)
        for crowd in null.CROWDS[1:]
    ]
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


def test_numbers_of_neighbours_have_their_own_null(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(null, "CLOUDS", 10)

    def limit(neighbours: int) -> float:
        return null.threshold("geodesic", 1, points=400, landmarks=25, neighbours=neighbours)

    assert limit(15) == limit(24) != limit(25) == limit(40)
    few = null.threshold("geodesic", 1, points=50, landmarks=25, neighbours=5)
    assert few == null._worst_quantiles("geodesic", 50, [(1, 25)], 10, 5)
    straight = null.threshold("euclidean", 1, points=50, landmarks=25)
    assert null.threshold("euclidean", 1, points=50, landmarks=25, neighbours=5) == straight


def test_crowds_beyond_the_table_count_as_its_last() -> None:
    last = null.threshold("geodesic", 1, points=12_800, landmarks=400)
    assert null.threshold("geodesic", 1, points=170_000, landmarks=400) == last


def test_pieces_of_a_graph_need_no_threshold() -> None:
    assert null.threshold("geodesic", 0, points=1000, landmarks=400) == np.inf
