from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from cogmap import CogmapError, CognitiveMap, EvenMemory
from cogmap.map.storage import write_state
from cogmap.shape.rips import euclidean, farthest_points


def walk(views: int, seed: int) -> np.ndarray:
    """Dwells at one corner of a square and rushes through the rest."""
    rng = np.random.default_rng(seed)
    return (rng.uniform(size=(views, 2)) ** 3).astype(np.float32)


def nearest(points: np.ndarray) -> np.ndarray:
    apart = cdist(points, points)
    np.fill_diagonal(apart, np.inf)
    return np.asarray(apart.min(axis=1))


@pytest.mark.parametrize("order", ["drawn", "sorted"])
def test_it_is_as_even_as_farthest_points(order: str) -> None:
    X = walk(2000, 0)
    X = X[np.argsort(X[:, 0])] if order == "sorted" else X
    memory = EvenMemory(200).partial_fit(X)
    best = X[farthest_points(euclidean(X), 200, 0).indices]
    assert len(memory) == 200
    assert memory.spacing_ == nearest(memory.codes_).min() > 0.85 * nearest(best).min()
    # No view is left out that is new.
    assert cdist(X, memory.codes_).min(axis=1).max() < 2 * memory.spacing_


def test_it_is_the_same_in_one_batch_and_in_many() -> None:
    X = walk(1200, 1)
    whole, parts = EvenMemory(150).partial_fit(X), EvenMemory(150)
    for first in range(0, 1200, 7):
        parts.partial_fit(X[first : first + 7])
    np.testing.assert_array_equal(parts.indices_, whole.indices_)
    np.testing.assert_array_equal(whole.codes_, X[whole.indices_])
    assert parts.seen_ == whole.seen_ == 1200


def test_until_it_is_full_it_keeps_all_but_repeats() -> None:
    X = walk(50, 2)
    memory = EvenMemory(60).partial_fit(np.concatenate([X, X[::-1]]))
    np.testing.assert_array_equal(memory.indices_, np.arange(50))
    assert memory.spacing_ == 0


def test_of_the_two_that_are_nearest_the_newer_one_is_forgotten() -> None:
    memory = EvenMemory(3).partial_fit(np.array([[0.0], [10.0], [10.4], [5.0], [5.1]]))
    assert set(memory.indices_) == {0, 1, 3}


def test_views_are_kept_as_they_are_and_compared_by_their_codes() -> None:
    images = np.random.default_rng(3).integers(256, size=(300, 4, 5, 3), dtype=np.uint8)
    codes = walk(300, 3)
    memory = EvenMemory(40).partial_fit(images, codes)
    assert memory.views_.dtype == np.uint8
    np.testing.assert_array_equal(memory.views_, images[memory.indices_])
    np.testing.assert_array_equal(memory.indices_, EvenMemory(40).partial_fit(codes).indices_)
    assert not np.array_equal(memory.indices_, EvenMemory(40).partial_fit(images).indices_)


def test_saved_and_loaded_it_goes_on_as_if_never_away(tmp_path: Path) -> None:
    X = walk(900, 4)
    memory = EvenMemory(100).partial_fit(X[:600])
    memory.save(tmp_path / "memory")
    assert {file.name for file in (tmp_path / "memory").iterdir()} == {"weights.safetensors", "memory.json"}
    loaded = EvenMemory.load(tmp_path / "memory")
    assert loaded.seen_ == 600
    for one in (memory, loaded):
        one.partial_fit(X[600:])
    np.testing.assert_array_equal(loaded.indices_, memory.indices_)
    np.testing.assert_array_equal(loaded.views_, memory.views_)
    assert loaded.spacing_ == memory.spacing_


def test_a_memory_that_is_not_full_is_saved_too(tmp_path: Path) -> None:
    memory = EvenMemory(100).partial_fit(walk(30, 5))
    memory.save(tmp_path / "memory")
    loaded = EvenMemory.load(tmp_path / "memory")
    assert (len(loaded), loaded.size, loaded.spacing_) == (30, 100, 0)
    loaded.partial_fit(walk(200, 6))
    assert len(loaded) == 100


def test_bad_input_gets_one_sentence(tmp_path: Path) -> None:
    X = walk(20, 7)
    with pytest.raises(CogmapError, match="size is 1"):
        EvenMemory(1).partial_fit(X)
    with pytest.raises(CogmapError, match="20 views but 10 codes"):
        EvenMemory().partial_fit(X, X[:10])
    with pytest.raises(CogmapError, match="NaN"):
        EvenMemory().partial_fit(np.full_like(X, np.nan))
    memory = EvenMemory(10).partial_fit(X)
    with pytest.raises(CogmapError, match=r"views of shape \(3,\) cannot stand beside \(2,\)"):
        memory.partial_fit(np.zeros((4, 3), np.float32))
    with pytest.raises(CogmapError, match="seen nothing"):
        EvenMemory().save(tmp_path / "memory")
    assert len(EvenMemory()) == 0
    for told in ("views_", "codes_", "indices_", "spacing_"):
        with pytest.raises(CogmapError, match="seen nothing"):
            getattr(EvenMemory(), told)
    with pytest.raises(CogmapError, match="cannot read a memory"):
        EvenMemory.load(tmp_path / "memory")
    memory.save(tmp_path / "memory")
    with pytest.raises(CogmapError, match="cannot read a map"):
        CognitiveMap.load(tmp_path / "memory")
    write_state(tmp_path / "other", {}, {"size": 5}, {"seen": 20}, kind="memory")
    with pytest.raises(CogmapError, match="does not hold a whole memory"):
        EvenMemory.load(tmp_path / "other")
