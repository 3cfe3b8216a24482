import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse.csgraph import shortest_path
from scipy.spatial import procrustes
from scipy.spatial.distance import cdist, pdist
from sklearn.manifold import Isomap
from sklearn.neighbors import KNeighborsRegressor
from sklearn.preprocessing import normalize
from sklearn.utils.estimator_checks import parametrize_with_checks
from threadpoolctl import threadpool_limits

from cogmap.errors import CogmapError, SeparatePiecesWarning
from cogmap.shape.isomap import LandmarkIsomap


@pytest.mark.filterwarnings("ignore::cogmap.errors.SeparatePiecesWarning")  # some of its clouds are blobs
@parametrize_with_checks(
    [
        LandmarkIsomap(2, neighbours=5),
        LandmarkIsomap(2, neighbours=5, landmarks=10),
        LandmarkIsomap(2, neighbours=5, metric="cosine"),
    ],
    expected_failed_checks=lambda _: {
        "check_do_not_raise_errors_in_init_or_set_params": "the tests' type checker refuses -1 for a bool"
    },
)
def test_it_is_a_scikit_learn_transformer(estimator, check) -> None:
    check(estimator)


def roll(n: int, rng: np.random.Generator) -> np.ndarray:
    angle = rng.uniform(np.pi, 3 * np.pi, n)
    return np.column_stack([angle * np.cos(angle), angle * np.sin(angle), rng.uniform(0, 10, n)])


def ring(n: int, rng: np.random.Generator) -> np.ndarray:
    angle = rng.uniform(0, 2 * np.pi, n)
    return np.column_stack([np.cos(angle), np.sin(angle)])


def words(n: int, rng: np.random.Generator) -> sp.csr_array:
    """Views of a ring of words, each seen within a window and best in its middle."""
    apart = np.abs(rng.uniform(0, 60, n)[:, None] - np.arange(60))
    seen = np.maximum(10 - np.minimum(apart, 60 - apart), 0)
    return normalize(sp.csr_array(seen * rng.uniform(0.5, 2, 60), dtype=np.float32))


@pytest.mark.parametrize("components", [1, 2, 3])
def test_with_all_points_as_landmarks_it_is_scikit_learns(components: int) -> None:
    X = roll(500, np.random.default_rng(0))
    mine = LandmarkIsomap(components, neighbours=8, landmarks=500).fit(X)
    theirs = Isomap(n_neighbors=8, n_components=components).fit(X)
    np.testing.assert_allclose(np.abs(mine.embedding_), np.abs(theirs.embedding_), atol=1e-8)
    fresh = roll(100, np.random.default_rng(1))
    same = np.sign((mine.embedding_ * theirs.embedding_).sum(axis=0))
    np.testing.assert_allclose(mine.transform(fresh), same * theirs.transform(fresh), atol=1e-8)


def test_bags_of_words_give_what_scikit_learn_makes_of_their_chords() -> None:
    X = words(400, np.random.default_rng(2))
    mine = LandmarkIsomap(2, neighbours=10, landmarks=400, metric="cosine").fit(X)
    theirs = Isomap(n_neighbors=10, n_components=2).fit(X)
    assert procrustes(mine.embedding_, theirs.embedding_)[2] < 1e-5


def test_graph_is_scikit_learns() -> None:
    X = roll(300, np.random.default_rng(3))
    theirs = Isomap(n_neighbors=6).fit(X)
    paths = shortest_path(LandmarkIsomap(neighbours=6).fit(X).graph_)
    np.testing.assert_allclose(paths, theirs.dist_matrix_, rtol=1e-9)


def test_few_landmarks_keep_the_geodesics() -> None:
    X = roll(1500, np.random.default_rng(4))
    few = LandmarkIsomap(2, neighbours=8, landmarks=100).fit(X)
    every = Isomap(n_neighbors=8, n_components=2).fit(X)
    paths = shortest_path(few.graph_)[np.triu_indices(1500, 1)]
    mine, theirs = (np.corrcoef(paths, pdist(Y))[0, 1] for Y in (few.embedding_, every.embedding_))
    assert abs(mine - theirs) < 0.002
    assert procrustes(few.embedding_, every.embedding_)[2] < 0.005


def test_other_points_come_where_they_would_have_come() -> None:
    rng = np.random.default_rng(5)
    X = roll(1200, rng)
    model = LandmarkIsomap(2, neighbours=8, landmarks=150).fit(X)
    np.testing.assert_allclose(model.transform(X), model.embedding_, atol=1e-9)
    # Unrolled, a point lies at its arc length and its height.
    fresh = roll(300, rng)
    angle = np.hypot(fresh[:, 0], fresh[:, 1])
    flat = np.column_stack([(angle * np.hypot(1, angle) + np.arcsinh(angle)) / 2, fresh[:, 2]])
    assert procrustes(flat, model.transform(fresh))[2] < 0.01


def test_averaging_takes_away_noise() -> None:
    rng = np.random.default_rng(6)
    place = rng.uniform(size=(2000, 2))
    X = np.hstack([place, rng.normal(scale=0.06, size=(2000, 20))])
    lost = {}
    for averaging in (False, True):
        model = LandmarkIsomap(2, averaging=averaging).fit(X[:1500])
        decoder = KNeighborsRegressor(10).fit(model.embedding_[:1000], place[:1000])
        lost[averaging] = [
            1 - decoder.score(model.embedding_[1000:], place[1000:1500]),
            1 - decoder.score(model.transform(X[1500:]), place[1500:]),
        ]
    assert lost[True][0] < 0.8 * lost[False][0]
    assert lost[True][1] < 0.8 * lost[False][1]


def test_averages_are_those_of_the_graph() -> None:
    X = ring(200, np.random.default_rng(7))
    raw, mean = (LandmarkIsomap(2, averaging=averaging).fit(X) for averaging in (False, True))
    near = raw.graph_.toarray() > 0
    for point in range(0, 200, 17):
        together = raw.embedding_[near[point] | (np.arange(200) == point)]
        np.testing.assert_allclose(mean.embedding_[point], together.mean(axis=0))


def test_pieces_keep_their_own_maps() -> None:
    rng = np.random.default_rng(8)
    parts = [ring(300, rng), roll(500, rng)[:, :2] + 100, rng.normal(size=(10, 2)) - 500]
    X = np.concatenate(parts)
    with pytest.warns(SeparatePiecesWarning, match=r"3 pieces \(of 500, 300, 10 points\)"):
        model = LandmarkIsomap(3, neighbours=8, landmarks=120).fit(X)
    assert model.pieces_.number == 3
    np.testing.assert_array_equal(model.pieces_.sizes, [500, 300, 10])
    np.testing.assert_array_equal(model.pieces_.labels, np.repeat([1, 0, 2], [300, 500, 10]))
    for start, part in ((0, parts[0]), (300, parts[1])):
        alone = LandmarkIsomap(3, neighbours=8, landmarks=len(part)).fit(part)
        assert procrustes(model.embedding_[start : start + len(part)], alone.embedding_)[2] < 0.01
    np.testing.assert_allclose(model.transform(X), model.embedding_, atol=1e-6)
    # A place between pieces goes to the nearer one.
    between = model.transform(np.array([[0.0, 1.1], [-499.0, -501.0]]))
    assert cdist(between[:1], model.embedding_[:300]).min() < 0.2
    assert np.isfinite(between).all()


def test_views_without_words_stay_alone() -> None:
    X = sp.csr_array(
        sp.vstack([words(200, np.random.default_rng(9)), sp.csr_array((3, 60))]), dtype=np.float32
    )
    with pytest.warns(SeparatePiecesWarning, match="2 pieces"):
        model = LandmarkIsomap(2, metric="cosine").fit(X)
    np.testing.assert_array_equal(model.pieces_.sizes, [200, 3])
    # They are the same view, at one place.
    np.testing.assert_allclose(model.embedding_[200:], 0, atol=1e-9)
    assert np.isnan(model.transform(X[200:])).all()
    assert np.isfinite(model.transform(X[:200])).all()


def test_repeated_points_share_a_place() -> None:
    X = ring(150, np.random.default_rng(10))
    model = LandmarkIsomap(2).fit(np.concatenate([X, X[:40]]))
    np.testing.assert_allclose(model.embedding_[150:], model.embedding_[:40], atol=1e-9)


def test_a_line_has_one_dimension() -> None:
    X = np.linspace(0, 1, 200)[:, None] ** 2
    embedding = LandmarkIsomap(3, neighbours=5).fit_transform(X)
    assert abs(np.corrcoef(X[:, 0], embedding[:, 0])[0, 1]) == pytest.approx(1)
    assert np.abs(embedding[:, 1:]).max() < 1e-5


@given(st.integers(0, 1000), st.integers(0, 1000))
@settings(deadline=None, max_examples=10)
def test_order_and_seed_do_not_matter_much(seed: int, shuffle: int) -> None:
    X = roll(400, np.random.default_rng(12))
    order = np.random.default_rng(shuffle).permutation(400)
    one = LandmarkIsomap(2, neighbours=8, landmarks=100).fit_transform(X)
    other = LandmarkIsomap(2, neighbours=8, landmarks=100, seed=seed).fit_transform(X[order])
    assert procrustes(one[order], other)[2] < 0.01


def test_same_bits_whatever_the_threads() -> None:
    X = words(1000, np.random.default_rng(13))
    models = []
    for threads in (1, 2):
        with threadpool_limits(limits=threads):
            models.append(LandmarkIsomap(3, landmarks=200, metric="cosine", seed=7).fit(X))
    np.testing.assert_array_equal(models[0].embedding_, models[1].embedding_)
    np.testing.assert_array_equal(models[0].transform(X[:50]), models[1].transform(X[:50]))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"components": 0}, "components is 0"),
        ({"landmarks": 0}, "landmarks is 0"),
        ({"neighbours": 0}, "neighbours is 0"),
        ({"neighbours": 50}, "50 distinct points cannot have 50"),
    ],
)
def test_bad_input_gets_one_sentence(options: dict[str, int], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        LandmarkIsomap(**options).fit(ring(50, np.random.default_rng(0)))
