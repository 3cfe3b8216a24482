from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.spatial.distance import cdist
from sklearn.base import clone
from sklearn.feature_extraction.text import TfidfTransformer

import cogmap.features.bag_of_words as words_module
from arena import Arena, Brownian, Camera, Recording, explore
from cogmap.errors import CogmapError
from cogmap.features.bag_of_words import BagOfWords
from cogmap.features.descriptors import keypoints, patches
from cogmap.graph.neighbour_graph import components, neighbour_graph
from cogmap.shape.isomap import LandmarkIsomap

FEW = {"words": 60, "colours": 20, "workers": 1}


@pytest.fixture(scope="module")
def model(views: np.ndarray) -> BagOfWords:
    return BagOfWords(**FEW).fit(views)


def test_bag_made_by_hand(views: np.ndarray, model: BagOfWords) -> None:
    shown = np.zeros((100, 80))
    for view in range(100):
        for describe, known, offset in ((keypoints, model.vocabulary_, 0), (patches, model.palette_, 60)):
            for spot in describe(views[view : view + 1]).values:
                shown[view, offset + cdist([spot], known).argmin()] = 1
    idf = np.log(100 / shown.sum(axis=0))
    by_hand = shown * idf
    by_hand /= np.linalg.norm(by_hand, axis=1, keepdims=True)
    np.testing.assert_allclose(model.idf_, idf, rtol=1e-6)
    found = model.transform(views)
    assert isinstance(found, sp.csr_array)
    assert found.dtype == np.float32
    np.testing.assert_allclose(found.toarray(), by_hand, atol=1e-6)
    # scikit-learn adds one to every idf; taking it away again gives the same weights.
    theirs = TfidfTransformer(smooth_idf=False).fit(shown).idf_ - 1
    np.testing.assert_allclose(model.idf_, theirs, rtol=1e-5, atol=1e-6)


def test_fitting_and_transforming_agree(views: np.ndarray, model: BagOfWords) -> None:
    again = clone(model)
    assert (again.fit_transform(views) != model.transform(views)).nnz == 0
    np.testing.assert_array_equal(again.vocabulary_, model.vocabulary_)
    part = model.transform(views[37:40])
    assert (part != model.transform(views)[37:40]).nnz == 0


def test_each_view_is_described_once(views: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(words_module, "BLOCK", 8)
    monkeypatch.setattr(words_module, "SAMPLE", 24)
    seen = []

    def describe(images: np.ndarray) -> tuple[object, object]:
        seen.extend(image.tobytes() for image in images)
        return keypoints(images), patches(images)

    monkeypatch.setattr(words_module, "_describe", describe)
    found = BagOfWords(**FEW).fit_transform(views)
    assert sorted(seen) == sorted(image.tobytes() for image in views)
    # Three blocks of eight are the sample, and rows come in the order of the views.
    assert seen[8] == views[40].tobytes()
    neighbours = (found @ found.T).toarray() - np.eye(100)
    assert np.median((np.abs(neighbours.argmax(axis=1) - np.arange(100)) + 1) % 100) <= 3


def test_same_bits_whatever_the_workers(views: np.ndarray, model: BagOfWords) -> None:
    two = BagOfWords(**{**FEW, "workers": 2})
    assert (two.fit_transform(views) != model.transform(views)).nnz == 0
    np.testing.assert_array_equal(two.vocabulary_, model.vocabulary_)
    np.testing.assert_array_equal(two.palette_, model.palette_)


def test_seed_changes_the_words(views: np.ndarray, model: BagOfWords) -> None:
    assert not np.array_equal(BagOfWords(**FEW, seed=1).fit(views).vocabulary_, model.vocabulary_)


def test_views_may_lie_on_disk(tmp_path: Path) -> None:
    walk = explore(
        Arena.load("furnished"), Brownian(), Camera.perspective(64, 48), views=70, out=tmp_path / "walk.zarr"
    )
    lazy = BagOfWords(**FEW).fit_transform(Recording.open(tmp_path / "walk.zarr").views)
    assert (lazy != BagOfWords(**FEW).fit_transform(np.asarray(walk.views))).nnz == 0


def test_views_next_to_each_other_share_most_words(views: np.ndarray, model: BagOfWords) -> None:
    rows = model.transform(views)
    cosine = (rows @ rows.T).toarray()
    beside = np.mean([cosine[i, (i + 1) % 100] for i in range(100)])
    opposite = np.mean([cosine[i, (i + 50) % 100] for i in range(100)])
    assert beside > 0.5
    assert beside > 2 * opposite
    np.testing.assert_allclose(np.diagonal(cosine), 1, atol=1e-6)


def test_constant_views_share_everything_and_say_nothing() -> None:
    grey = np.full((30, 48, 64, 3), 128, np.uint8)
    model = BagOfWords(**FEW)
    rows = model.fit_transform(grey)
    assert model.vocabulary_.shape == (0, 128)
    assert model.palette_.shape == (1, 12)
    assert rows.shape == (30, 1)
    assert rows.nnz == 0


def test_views_without_keypoints_are_legal(views: np.ndarray) -> None:
    blank = np.full_like(views[:3], 128)
    rows = BagOfWords(**FEW).fit_transform(np.concatenate([views, blank]))
    assert np.isfinite(rows.data).all()
    assert rows[100:, :60].nnz == 0
    graph = neighbour_graph(rows, 8, metric="cosine")
    assert components(graph).sizes[0] >= 100
    embedding = LandmarkIsomap(2, neighbours=8, metric="cosine").fit(rows)
    assert np.isfinite(embedding.embedding_).all()
    # Words learnt from textured views know a blank one by its colour or not at all.
    assert BagOfWords(**FEW).fit(views).transform(blank).nnz <= 3 * 20


def test_one_view_says_nothing(views: np.ndarray) -> None:
    rows = BagOfWords(**FEW).fit_transform(views[:1])
    assert rows.shape[0] == 1
    assert rows.nnz == 0


def test_repeated_views_have_equal_rows(views: np.ndarray) -> None:
    rows = BagOfWords(**FEW).fit_transform(np.concatenate([views[:40], views[:40]]))
    assert (rows[:40] != rows[40:]).nnz == 0


def test_progress_counts_views(views: np.ndarray, capsys: pytest.CaptureFixture[str]) -> None:
    BagOfWords(**FEW, progress=True).fit(views[:20])
    captured = capsys.readouterr()
    assert "20/20" in captured.err
    assert not captured.out


@pytest.mark.parametrize(
    ("options", "message"),
    [({"words": 0}, "words is 0"), ({"colours": -1}, "colours is -1"), ({"seed": -1}, "seed is -1")],
)
def test_bad_options_get_one_sentence(views: np.ndarray, options: dict[str, int], message: str) -> None:
    with pytest.raises(CogmapError, match=message):
        BagOfWords(**{**FEW, **options}).fit(views)


@pytest.mark.parametrize(
    "bad", [np.zeros((3, 4, 4, 3)), np.zeros((3, 4, 4), np.uint8), np.zeros((0, 4, 4, 3), np.uint8), [1, 2]]
)
def test_bad_views_get_one_sentence(model: BagOfWords, bad: object) -> None:
    for use in (BagOfWords(**FEW).fit, model.transform):
        with pytest.raises(CogmapError, match="views"):
            use(bad)
