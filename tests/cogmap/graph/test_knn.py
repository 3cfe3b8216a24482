import sys
from collections.abc import Callable

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import cdist
from sklearn.preprocessing import normalize

from cogmap.errors import CogmapError
from cogmap.graph import knn
from cogmap.graph.knn import Metric, PointSearch, nearest_points
from cogmap.graph.points import Cloud


def bags(n: int, rng: np.random.Generator, words: int = 60, share: float = 0.2) -> sp.csr_array:
    return sp.csr_array((rng.uniform(size=(n, words)) < share) * rng.uniform(0.5, 2, words))


def by_hand(queries: np.ndarray, cloud: np.ndarray) -> np.ndarray:
    """Chords from cosines; infinite where no word is shared."""
    cosine = normalize(queries) @ normalize(cloud).T
    return np.where(cosine > 0, np.sqrt(np.maximum(2 - 2 * cosine, 0)), np.inf)


@pytest.fixture
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(knn, "BLOCK", 16)


@pytest.mark.usefixtures("small_blocks")
@given(st.integers(0, 1000), st.integers(1, 12), st.sampled_from([1, 15, 16, 17, 50, 64]))
@settings(deadline=None, max_examples=30)
def test_cosine_neighbours_of_others(seed: int, neighbours: int, views: int) -> None:
    rng = np.random.default_rng(seed)
    cloud, queries = bags(70, rng), bags(views, rng)
    found = nearest_points(cloud, neighbours, queries=queries, metric="cosine")
    chords = by_hand(queries.toarray(), cloud.toarray())
    np.testing.assert_allclose(found.distances, np.sort(chords, axis=1)[:, :neighbours], atol=1e-7)
    there = found.indices >= 0
    rows = np.arange(views)[:, None]
    np.testing.assert_allclose(chords[rows, found.indices][there], found.distances[there], atol=1e-7)
    np.testing.assert_array_equal(there, np.isfinite(found.distances))


@pytest.mark.usefixtures("small_blocks")
@given(st.integers(0, 1000), st.integers(1, 12), st.sampled_from([15, 16, 17, 50, 64]), st.booleans())
@settings(deadline=None, max_examples=30)
def test_cosine_neighbours_among_themselves(seed: int, neighbours: int, views: int, dense: bool) -> None:  # noqa: FBT001
    cloud = bags(views, np.random.default_rng(seed))
    chords = by_hand(cloud.toarray(), cloud.toarray())
    np.fill_diagonal(chords, np.inf)
    found = nearest_points(cloud.toarray() if dense else cloud, neighbours, metric="cosine")
    np.testing.assert_allclose(found.distances, np.sort(chords, axis=1)[:, :neighbours], atol=1e-7)


@pytest.mark.parametrize("metric", ["euclidean", "cosine"])
def test_a_cloud_that_is_searched_again_is_prepared_once(
    metric: Metric, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(0)
    cloud = rng.normal(size=(80, 5))
    search = PointSearch(cloud, metric=metric)
    monkeypatch.setattr(knn.NearestNeighbors, "fit", None)
    for neighbours, views in ((3, 7), (5, 1)):
        queries = rng.normal(size=(views, 5))
        found = search(neighbours, queries)
        apart = by_hand(queries, cloud) if metric == "cosine" else cdist(queries, cloud)
        np.testing.assert_array_equal(found.indices, np.argsort(apart, axis=1)[:, :neighbours])
        np.testing.assert_allclose(found.distances, np.sort(apart, axis=1)[:, :neighbours], atol=1e-7)


def test_equals_are_ranked_by_index(small_blocks: None) -> None:
    del small_blocks
    cloud = sp.csr_array(np.ones((40, 3)))
    found = nearest_points(cloud, 3, metric="cosine")
    np.testing.assert_array_equal(found.indices[:4], [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])
    np.testing.assert_array_equal(found.indices[4:], np.tile([0, 1, 2], (36, 1)))


def test_blocks_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    cloud = sp.csr_array(bags(300, np.random.default_rng(0)), dtype=np.float32)
    one = nearest_points(cloud, 7, metric="cosine")
    monkeypatch.setattr(knn, "BLOCK", 64)
    other = nearest_points(cloud, 7, metric="cosine")
    np.testing.assert_allclose(one.distances, other.distances, atol=1e-3)
    assert (one.indices == other.indices).mean() > 0.99


def test_euclidean_neighbours() -> None:
    rng = np.random.default_rng(1)
    cloud, queries = rng.normal(size=(80, 4)), rng.normal(size=(20, 4))
    apart = cdist(queries, cloud)
    found = nearest_points(cloud, 5, queries=queries)
    np.testing.assert_array_equal(found.indices, np.argsort(apart, axis=1)[:, :5])
    np.testing.assert_allclose(found.distances, np.sort(apart, axis=1)[:, :5])
    sparse = nearest_points(sp.csr_array(cloud), 5, queries=sp.csr_array(queries))
    np.testing.assert_array_equal(found.indices, sparse.indices)


def ring_of_words(views: int) -> np.ndarray:
    angle = np.random.default_rng(2).uniform(0, 2 * np.pi, views)
    seen = np.maximum(np.cos(angle[:, None] - np.linspace(0, 2 * np.pi, 40, endpoint=False)), 0)
    seen[[3, -2]] = 0
    return seen


def compare_with_exact(cloud: Cloud, queries: Cloud | None, metric: knn.Metric) -> None:
    exact = nearest_points(cloud, 10, queries=queries, metric=metric)
    close = nearest_points(cloud, 10, queries=queries, metric=metric, exact=100)
    assert close.distances.shape == exact.distances.shape
    none = exact.indices < 0
    np.testing.assert_array_equal(close.indices < 0, none)
    np.testing.assert_array_equal(np.isinf(close.distances), none)
    pairs = zip(exact.indices, close.indices, strict=True)
    assert np.mean([np.isin(ours, theirs).mean() for ours, theirs in pairs]) > 0.97
    alike = exact.indices == close.indices
    np.testing.assert_allclose(close.distances[alike], exact.distances[alike], atol=1e-3)


# The kernels of pynndescent take a minute to compile in every process.
@pytest.mark.full
@pytest.mark.parametrize("metric", ["euclidean", "cosine"])
@pytest.mark.parametrize("kind", [np.asarray, sp.csr_array])
@pytest.mark.filterwarnings("ignore")
def test_descent_finds_nearly_the_same(metric: knn.Metric, kind: Callable[[np.ndarray], Cloud]) -> None:
    seen = ring_of_words(1100)
    compare_with_exact(kind(seen[:1000]), None, metric)
    compare_with_exact(kind(seen[:1000]), kind(seen[900:]), metric)


@pytest.mark.full
def test_descent_gives_the_same_twice() -> None:
    X = np.random.default_rng(3).normal(size=(500, 5))
    one, other = (nearest_points(X, 8, exact=100) for _ in range(2))
    np.testing.assert_array_equal(one.indices, other.indices)
    assert (one.indices != np.arange(500)[:, None]).all()


def test_large_clouds_need_their_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pynndescent", None)
    with pytest.raises(CogmapError, match=r"neighbours of 20 points .*pip install 'cogmap\[large\]'"):
        nearest_points(GOOD, 3, exact=19)
    nearest_points(GOOD, 3, exact=20)


def test_descent_is_asked_for_directions(monkeypatch: pytest.MonkeyPatch) -> None:
    def descend(cloud: Cloud, queries: Cloud | None, neighbours: int) -> knn.Nearest:
        lengths = [np.linalg.norm(part.toarray(), axis=1) for part in (cloud, queries) if part is not None]
        np.testing.assert_allclose(np.concatenate(lengths), 1)
        return nearest_points(cloud, neighbours, queries=queries)

    monkeypatch.setattr(knn, "_by_descent", descend)
    seen = ring_of_words(210)
    compare_with_exact(sp.csr_array(seen), None, "cosine")
    compare_with_exact(sp.csr_array(seen[:200]), sp.csr_array(seen[190:]), "cosine")
    # At right angles to all but a few.
    alone = np.kron(np.eye(60), np.ones((3, 4)) + np.random.default_rng(6).uniform(size=(3, 4)))
    compare_with_exact(sp.csr_array(alone), None, "cosine")


GOOD = np.random.default_rng(5).normal(size=(20, 3))


@pytest.mark.parametrize(
    ("cloud", "options", "message"),
    [
        (GOOD[:, 0], {}, r"shape \(20,\)"),
        (np.where(GOOD > 1, np.nan, GOOD), {}, "NaN"),
        (sp.csr_array(GOOD * np.inf), {}, "infinite"),
        (GOOD, {"queries": GOOD[:, :2]}, "queries have 2 features but the cloud has 3"),
        (GOOD, {"neighbours": 20}, "20 points are too few for 20 neighbours"),
        (GOOD, {"neighbours": 21, "queries": GOOD}, "20 points are too few for 21 neighbours"),
        (GOOD, {"neighbours": 0}, "neighbours is 0"),
    ],
)
def test_bad_input_gets_one_sentence(cloud: np.ndarray, options: dict[str, object], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        nearest_points(cloud, **{"neighbours": 3, **options})
