from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pytest
import scipy.sparse as sp
import torch
from scipy.spatial.distance import cdist

from cogmap.errors import CogmapError
from cogmap.graph.neighbour_graph import neighbour_graph
from cogmap.shape.homology import Betti, _check_options, betti
from cogmap.shape.rips import farthest_points, geodesic, rips_bars
from cogmap.testing import assert_betti

Sampler = Callable[[int, np.random.Generator], np.ndarray]


def circle(n: int, rng: np.random.Generator) -> np.ndarray:
    angle = rng.uniform(0, 2 * np.pi, n)
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def disc(n: int, rng: np.random.Generator, hole: float = 0.0) -> np.ndarray:
    return circle(n, rng) * np.sqrt(rng.uniform(hole**2, 1, (n, 1)))


def ball(n: int, rng: np.random.Generator) -> np.ndarray:
    X = rng.normal(size=(n, 3))
    return X * rng.uniform(size=(n, 1)) ** (1 / 3) / np.linalg.norm(X, axis=1, keepdims=True)


def cylinder(n: int, rng: np.random.Generator) -> np.ndarray:
    return np.hstack([circle(n, rng), rng.uniform(0, 2, (n, 1))])


def solid_torus(n: int, rng: np.random.Generator) -> np.ndarray:
    return np.hstack([disc(n, rng), circle(n, rng)])


def torus(n: int, rng: np.random.Generator) -> np.ndarray:
    return np.hstack([circle(n, rng), circle(n, rng)])


def sphere(n: int, rng: np.random.Generator) -> np.ndarray:
    X = rng.normal(size=(n, 3))
    return X / np.linalg.norm(X, axis=1, keepdims=True)


def annulus_times_circle(n: int, rng: np.random.Generator) -> np.ndarray:
    return np.hstack([disc(n, rng, hole=0.4), 0.7 * circle(n, rng)])


def two_discs(n: int, rng: np.random.Generator) -> np.ndarray:
    X = disc(n, rng)
    X[: n // 2, 0] += 3
    return X


def grid_module(n: int, rng: np.random.Generator) -> np.ndarray:
    """Roots of the rates of 25 ideal grid cells of one spacing and orientation, whose phases are spread."""
    axes = np.array([[1, 0], [0.5, np.sqrt(3) / 2]])
    away = rng.uniform(-3, 3, (n, 1, 2)) - np.argwhere(np.ones((5, 5))) / 5 @ axes
    crests = np.linalg.inv(axes) @ [[1, 0, -1], [0, 1, 1]]
    return np.exp((np.cos(2 * np.pi * away @ crests).sum(axis=2) - 3) / 2)


SPACES: dict[Sampler, tuple[int, int, int]] = {
    circle: (1, 1, 0),
    cylinder: (1, 1, 0),
    solid_torus: (1, 1, 0),
    torus: (1, 2, 1),
    grid_module: (1, 2, 1),
    disc: (1, 0, 0),
    ball: (1, 0, 0),
    sphere: (1, 0, 1),
    annulus_times_circle: (1, 2, 1),
    two_discs: (2, 0, 0),
}
FEW = (200, 100)
"""Landmarks that are enough here, and quick."""
FEWER = (100, 60)
"""Enough to tell whether two answers are the same."""


@pytest.mark.parametrize("space", SPACES, ids=lambda space: space.__name__)
def test_known_spaces(space: Sampler) -> None:
    assert_betti(space(1500, np.random.default_rng(0)), SPACES[space], landmarks=FEW, draws=1)


@pytest.mark.parametrize("space", [circle, torus, sphere, disc, ball, two_discs], ids=lambda s: s.__name__)
def test_known_spaces_by_straight_lines(space: Sampler) -> None:
    X = space(1500, np.random.default_rng(1))
    assert_betti(X, SPACES[space], "euclidean", landmarks=FEW, draws=1)


@pytest.mark.parametrize("space", [circle, solid_torus, torus, disc], ids=lambda s: s.__name__)
def test_known_spaces_in_many_dimensions_with_noise(space: Sampler) -> None:
    rng = np.random.default_rng(2)
    X = space(2000, rng)
    axes = np.linalg.qr(rng.normal(size=(30, X.shape[1])))[0]
    X = X @ axes.T + rng.normal(scale=0.03, size=(2000, 30))
    assert_betti(X.astype(np.float32), SPACES[space], landmarks=FEW, draws=1)


@pytest.mark.parametrize("space", [circle, sphere, disc, ball, two_discs], ids=lambda s: s.__name__)
def test_fewer_points_than_landmarks(space: Sampler) -> None:
    found = betti(space(120, np.random.default_rng(4)))
    assert found.numbers == SPACES[space], str(found)
    assert found.landmarks == (120, 120, 120)


def test_precomputed_distances_may_be_infinite_between_pieces() -> None:
    rng = np.random.default_rng(3)
    X = np.concatenate([circle(150, rng), disc(150, rng)])
    distances = cdist(X, X)
    distances[:150, 150:] = distances[150:, :150] = np.inf
    assert betti(distances, "precomputed", max_dimension=1).numbers == (2, 1)


def test_precomputed_distances_give_what_the_points_give() -> None:
    X = np.unique(cylinder(600, np.random.default_rng(4)), axis=0)
    points = betti(X, "euclidean", landmarks=FEWER)
    distances = betti(cdist(X, X), "precomputed", landmarks=FEWER)
    assert points.numbers == distances.numbers
    for one, other in zip(points.bars, distances.bars, strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("space", [cylinder, two_discs], ids=lambda s: s.__name__)
def test_neighbour_graph_gives_what_the_points_give(space: Sampler) -> None:
    X = np.unique(space(500, np.random.default_rng(12)), axis=0)
    points = betti(X, landmarks=FEWER)
    graph = betti(neighbour_graph(X), "precomputed", landmarks=FEWER)
    assert str(graph) == str(points).replace("geodesic", "precomputed")
    for one, other in zip(points.bars, graph.bars, strict=True):
        np.testing.assert_array_equal(one, other)


def test_outliers_are_no_pieces() -> None:
    rng = np.random.default_rng(5)
    X = np.concatenate([disc(1000, rng), [[5, 5], [-6, 2], [0, 9], [0.1, 9]]])
    assert betti(X, "euclidean", landmarks=FEW).numbers == (1, 0, 0)
    X = np.concatenate([X, disc(100, rng) / 4 - 10])
    assert betti(X, "euclidean", landmarks=FEW).numbers == (2, 0, 0)


def test_same_seed_and_any_order_give_the_same() -> None:
    rng = np.random.default_rng(6)
    X = solid_torus(500, rng)
    one = betti(X, seed=3, draws=2, landmarks=FEWER)
    same = betti(rng.permutation(np.concatenate([X, X[:50]])), seed=3, draws=2, landmarks=FEWER)
    assert one.points == same.points == 500
    assert str(one) == str(same)
    for bars, others in zip(one.bars, same.bars, strict=True):
        np.testing.assert_array_equal(bars, others)
    assert str(one) != str(betti(X, seed=4, draws=2, landmarks=FEWER))


def test_bars_are_the_same_on_one_core(monkeypatch: pytest.MonkeyPatch) -> None:
    from cogmap.graph import shortest_paths  # noqa: PLC0415
    from cogmap.shape import homology  # noqa: PLC0415

    X = torus(400, np.random.default_rng(13))
    several = []
    for cores in (1, 3):
        for module in (homology, shortest_paths):
            monkeypatch.setattr(module, "cpu_count", lambda cores=cores: cores)
        several.append(betti(X, landmarks=FEWER))
    assert str(several[0]) == str(several[1])
    for one, other in zip(several[0].bars, several[1].bars, strict=True):
        np.testing.assert_array_equal(one, other)


def test_bars_are_those_of_the_landmarks() -> None:
    X = np.unique(cylinder(500, np.random.default_rng(7)), axis=0)
    found = betti(X, seed=11, draws=1, landmarks=FEWER)
    start = int(np.random.default_rng(11).integers(500, size=1)[0])
    seen = geodesic(X, 15)
    distances = seen.among(farthest_points(seen, 100, start).indices)
    assert found.landmarks == (100, 100, 60)
    np.testing.assert_array_equal(found.bars[1], rips_bars(distances, [1])[0])
    np.testing.assert_array_equal(found.bars[2], rips_bars(distances[:60, :60], [2])[0])


def test_result_says_how_sure_it_is() -> None:
    found = betti(cylinder(1500, np.random.default_rng(8)), landmarks=FEW)
    assert found.draws == 3
    assert all(2 <= votes <= 3 for votes in found.votes)
    assert found.thresholds[0] == np.inf
    (_, (last_in, first_out), (nothing_in, _)) = found.margins
    assert last_in is not None
    assert first_out is not None
    assert nothing_in is None
    assert last_in == pytest.approx(found.ratios[1][0] / found.thresholds[1])
    assert first_out == pytest.approx(found.ratios[1][1] / found.thresholds[1])
    assert last_in > 1
    assert first_out < 1
    assert f"{found.ratios[1][0]:.2f}" in str(found)


def test_other_looks_must_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    from cogmap.shape import homology  # noqa: PLC0415

    X = cylinder(300, np.random.default_rng(8))
    asked: list[tuple[int, list[str]]] = []

    def doubt(*args: Any) -> str:
        asked.append((len(args[2]), [how for how, _ in args[3]]))
        return "so"

    monkeypatch.setattr(homology, "doubt", doubt)
    assert betti(X, landmarks=FEWER).reasons == ("so",) * 3
    assert betti(X, landmarks=FEWER, check=None, draws=1).resolved == (False,) * 3
    assert betti(X[:25], check=25, draws=1).numbers[0] == 1
    assert betti(X, "euclidean", landmarks=FEWER, draws=1).metric == "euclidean"
    more, pieces = "with 25 neighbours", "without outliers"
    assert asked[:3] == [(3, [more, pieces]), (3, [more]), (3, [more])]
    assert asked[3:] == 2 * [(1, [pieces]), (1, []), (1, [])] + 3 * [(1, [])]


def test_the_second_graph_has_its_own_neighbours_and_thresholds(monkeypatch: pytest.MonkeyPatch) -> None:
    from cogmap.shape import homology  # noqa: PLC0415

    X = np.unique(cylinder(400, np.random.default_rng(8)), axis=0)
    alone = betti(X, landmarks=FEWER, draws=1, neighbours=25, check=None)
    told: list[np.ndarray] = []
    monkeypatch.setattr(homology, "doubt", lambda *args: told.append(args[3][0][1]) or "")
    betti(X, landmarks=FEWER, draws=1)
    np.testing.assert_array_equal(told[1], alone.ratios[1] / alone.thresholds[1])
    np.testing.assert_array_equal(told[2], alone.ratios[2] / alone.thresholds[2])


def test_pieces_that_a_few_strays_join_are_not_resolved() -> None:
    X = two_discs(800, np.random.default_rng(14))
    for strays, reason in ((0, ""), (3, "without outliers it is 2")):
        bridge = np.column_stack([1.5 + 0.03 * np.arange(strays), np.zeros(strays)])
        found = betti(np.vstack([X, bridge]), max_dimension=0, landmarks=FEWER)
        assert (found.numbers, found.reasons) == ((1 if strays else 2,), (reason,)), str(found)


def test_short_cuts_are_shunned() -> None:
    """Ten edges between far places, as long as any other: taken for what they say, each makes a loop."""
    rng = np.random.default_rng(1)
    graph = neighbour_graph(cylinder(1500, rng))
    ends = rng.integers(1500, size=(2, 10))
    jumps = sp.csr_array((np.full(10, np.median(graph.data)), tuple(ends)), shape=graph.shape)
    graph = sp.csr_array(graph.maximum(jumps).maximum(jumps.T))
    found = betti(graph, "precomputed", landmarks=FEW, draws=1)
    assert (found.numbers, found.resolved) == ((1, 1, 0), (True,) * 3), str(found)


def test_fewer_dimensions_on_request() -> None:
    found = betti(two_discs(600, np.random.default_rng(9)), max_dimension=0)
    assert found.numbers == (2,)
    assert len(found.bars) == len(found.votes) == len(found.landmarks) == 1


def test_majority_of_the_draws_decides(monkeypatch: pytest.MonkeyPatch) -> None:
    from cogmap.shape import homology  # noqa: PLC0415

    loops = iter([3, 1, 1, 0, 2, 1])
    bars = np.array([[1.0, 9.0]])
    monkeypatch.setattr(
        homology,
        "_find",
        lambda *_, **__: homology._Found(np.repeat(bars, next(loops), axis=0), 2.0, 400),
    )
    found: Betti = betti(disc(100, np.random.default_rng(10)), max_dimension=0, draws=5, check=None)
    assert (found.numbers, found.votes) == ((1,), (2,))


GOOD = np.random.default_rng(0).normal(size=(30, 3))
APART = cdist(GOOD, GOOD)


@pytest.mark.parametrize(
    ("X", "options", "message"),
    [
        (np.where(GOOD > 2, np.nan, GOOD), {}, "NaN"),
        (GOOD * np.inf, {}, "infinite"),
        (GOOD[:, 0], {}, r"shape \(30,\)"),
        (GOOD[:, :, None], {}, r"shape \(30, 3, 1\)"),
        (GOOD[:0], {}, "0 distinct points"),
        (GOOD[:9], {"metric": "euclidean"}, "9 distinct points are too few"),
        (GOOD[:12], {}, "12 distinct points cannot have 15"),
        (np.zeros((100, 2)), {}, "1 distinct points"),
        (GOOD, {"max_dimension": 3}, "max_dimension is 3"),
        (GOOD, {"draws": 0}, "0 draws"),
        (GOOD, {"landmarks": (400, 5)}, r"landmarks \(400, 5\)"),
        (GOOD, {"neighbours": 0}, "neighbours is 0"),
        (GOOD, {"metric": "precomputed"}, r"shape \(30, 3\); expected a square"),
        (APART[:5, :5], {"metric": "precomputed"}, "5 distinct points"),
        (-APART, {"metric": "precomputed"}, "negative"),
        (APART * np.nan, {"metric": "precomputed"}, "NaN"),
        (np.triu(APART), {"metric": "precomputed"}, "not symmetric"),
        (APART + 1, {"metric": "precomputed"}, "zero diagonal"),
        (sp.csr_array(APART), {}, "sparse with the metric 'geodesic'"),
        (sp.csr_array(APART[:5, :5]), {"metric": "precomputed"}, "5 distinct points"),
        (sp.csr_array(np.triu(APART)), {"metric": "precomputed"}, "graph is not symmetric"),
    ],
)
def test_bad_input_gets_one_sentence(
    X: np.ndarray | sp.csr_array, options: dict[str, object], message: str
) -> None:
    with pytest.raises(CogmapError, match=message) as caught:
        betti(X, **options)
    assert "\n" not in str(caught.value)


def test_unknown_metric_gets_one_sentence() -> None:
    # The run-time type check of the tests would catch it earlier in `betti` itself.
    with pytest.raises(CogmapError, match="'cosine'; choose one of geodesic, euclidean, precomputed"):
        _check_options("cosine", 2, (400, 150), 3)


def rounded(kind: str) -> np.ndarray:
    angle = np.linspace(0, 2 * np.pi, 120, endpoint=False)
    X = np.column_stack([np.cos(angle), np.sin(angle)])
    if kind == "correlation":
        return 1 - np.corrcoef(np.exp(3 * np.cos(angle[:, None] - angle[::3])))
    squares = (X**2).sum(axis=1)
    X, squares = (array.astype(kind) for array in (X, squares))
    return np.sqrt(np.maximum(squares[:, None] + squares - 2 * X @ X.T, 0))


@pytest.mark.parametrize("kind", ["correlation", "float64", "float32"])
def test_distances_are_symmetric_but_for_rounding(kind: str) -> None:
    D = rounded(kind)
    assert np.diagonal(D).any() or (D != D.T).any()
    assert betti(D, "precomputed", max_dimension=1, draws=1).numbers == (1, 1)


@pytest.mark.parametrize("kind", [np.ndarray.tolist, pd.DataFrame, torch.from_numpy])
def test_clouds_and_distances_may_be_lists_frames_and_tensors(kind: Callable[[np.ndarray], object]) -> None:
    D = rounded("float64")
    for X, metric in ((D[:, :3], "euclidean"), (D, "precomputed")):
        one, other = (betti(given, metric, max_dimension=0, seed=np.int64(1)) for given in (X, kind(X)))
        np.testing.assert_array_equal(one.bars[0], other.bars[0])
