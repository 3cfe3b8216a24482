from contextlib import AbstractContextManager
from pathlib import Path

import numpy as np
import pytest

from arena.errors import ArenaError
from arena.recordings import storage
from arena.recordings.sharding import shards, write_shards

COLUMNS = {"times": np.arange(600.0), "odours": np.ones((600, 2), np.float32)}


def new_folder(path: Path, count: int = 600) -> AbstractContextManager[Path]:
    columns = {name: values[:count] for name, values in COLUMNS.items()}
    return storage.new_folder(path, (count, 2, 3, 3), columns, {"seed": 1})


def interrupted(path: Path) -> None:
    with new_folder(path) as folder:
        (folder / "data").write_text("1")
        raise KeyboardInterrupt


def overtaken(path: Path) -> None:
    with new_folder(path):
        path.mkdir()
        (path / "mine").write_text("mine")


def test_new_folder_appears_whole_or_not_at_all(tmp_path: Path) -> None:
    with new_folder(tmp_path / "deep" / "x") as folder:
        assert folder.parent == tmp_path / "deep"
        assert not (tmp_path / "deep" / "x").exists()
        (folder / "data").write_text("1")
    assert (tmp_path / "deep" / "x" / "data").read_text() == "1"
    with pytest.raises(KeyboardInterrupt):
        interrupted(tmp_path / "y")
    assert [path.name for path in tmp_path.iterdir()] == ["deep"]


def test_what_came_in_between_is_not_overwritten(tmp_path: Path) -> None:
    with pytest.raises(ArenaError, match="cannot write"):
        overtaken(tmp_path / "x")
    assert [path.name for path in tmp_path.rglob("*")] == ["x", "mine"]


def test_what_is_missing_is_known_and_can_be_written(tmp_path: Path) -> None:
    with new_folder(tmp_path / "x"):
        pass
    images = np.random.default_rng(0).integers(0, 256, (600, 2, 3, 3), dtype=np.uint8)
    first, second, third = shards(600)
    assert storage.load(tmp_path / "x").missing == [first, second, third]
    write_shards(tmp_path / "x" / "views", [(second, images[second])])
    stored = storage.load(tmp_path / "x")
    assert stored.missing == [first, third]
    assert stored.attributes == {"seed": 1}
    write_shards(tmp_path / "x" / "views", ((rows, images[rows]) for rows in stored.missing))
    stored = storage.load(tmp_path / "x")
    assert stored.missing == []
    np.testing.assert_array_equal(stored.views[:], images)


@pytest.mark.parametrize("chosen", [[], [599], [3, 300, 3, 255, 256], list(range(600))])
def test_reading_by_index(tmp_path: Path, chosen: list[int]) -> None:
    with new_folder(tmp_path / "x"):
        pass
    images = np.random.default_rng(0).integers(0, 256, (600, 2, 3, 3), dtype=np.uint8)
    write_shards(tmp_path / "x" / "views", ((rows, images[rows]) for rows in shards(600)))
    index = np.array(chosen, dtype=int)
    stored = storage.load(tmp_path / "x")
    np.testing.assert_array_equal(stored.views[index], images[index])


@pytest.mark.parametrize(
    "key",
    [
        0,
        -1,
        slice(250, 300),
        slice(None, None, -50),
        np.arange(600) % 7 == 0,
        np.array([[3, 599], [256, 0]]),
        (slice(254, 258), slice(0, 1)),
        (..., 0),
        (5, 1, slice(None), 2),
        ...,
    ],
    ids=str,
)
def test_views_on_disk_are_indexed_like_an_array(tmp_path: Path, key: object) -> None:
    with new_folder(tmp_path / "x"):
        pass
    images = np.random.default_rng(0).integers(0, 256, (600, 2, 3, 3), dtype=np.uint8)
    write_shards(tmp_path / "x" / "views", ((rows, images[rows]) for rows in shards(600)))
    views = storage.load(tmp_path / "x").views
    np.testing.assert_array_equal(views[key], images[key])
    assert np.shape(views[key]) == np.shape(images[key])
    assert (len(views), views.shape, views.ndim, views.dtype) == (600, images.shape, 4, np.uint8)


def test_views_on_disk_become_an_array(tmp_path: Path) -> None:
    with new_folder(tmp_path / "x", 3):
        pass
    write_shards(tmp_path / "x" / "views", [(slice(0, 3), np.full((3, 2, 3, 3), 7, np.uint8))])
    assert np.asarray(storage.load(tmp_path / "x").views, dtype=np.float32).sum() == 7 * 54
    with pytest.raises(IndexError):
        storage.load(tmp_path / "x").views[3]
