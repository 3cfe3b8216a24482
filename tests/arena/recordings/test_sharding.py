import errno
import os
import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import zarr
from hypothesis import given
from hypothesis import strategies as st

from arena.recordings import sharding
from arena.recordings.sharding import SHARD, codecs, file, is_complete, shards, write_shards

INDEX = 16 * SHARD + 4
IMAGES = np.random.default_rng(0).integers(0, 9, (SHARD + 44, 4, 6, 3), dtype=np.uint8)
FIRST, SECOND = shards(len(IMAGES))


@pytest.fixture
def written(tmp_path: Path) -> Path:
    write_shards(tmp_path, ((rows, IMAGES[rows]) for rows in (FIRST, SECOND)))
    return tmp_path


def by_zarr(folder: Path, images: np.ndarray = IMAGES) -> None:
    array = zarr.create_array(
        folder,
        shape=IMAGES.shape,
        dtype="uint8",
        chunks=(1, *IMAGES.shape[1:]),
        shards=(SHARD, *IMAGES.shape[1:]),
        compressors=codecs(),
    )
    array[:] = images


@pytest.mark.parametrize("count", [0, 1, 255, 256, 257, 1000])
def test_shards_cut_all_views_once(count: int) -> None:
    rows = [np.arange(count)[shard] for shard in shards(count)]
    np.testing.assert_array_equal(np.concatenate([[], *rows]), np.arange(count))
    assert all(len(row) == 256 for row in rows[:-1])


def test_images_are_those_of_zarr_to_the_byte(tmp_path: Path, written: Path) -> None:
    """The index is as long as there, with other offsets: the shard begins with its number."""
    by_zarr(tmp_path / "zarr")
    for number, rows in enumerate((FIRST, SECOND)):
        content, zarrs = file(written, rows).read_bytes(), file(tmp_path / "zarr", rows).read_bytes()
        assert content[:8] == bytes([number, *[0] * 7])
        assert content[8:-INDEX] == zarrs[:-INDEX]
        assert len(content) == 8 + len(zarrs)
    assert sorted(path for path in written.rglob("*") if path.is_file() and "zarr" not in path.parts) == [
        file(written, FIRST),
        file(written, SECOND),
    ]


def test_what_is_written_is_whole(written: Path) -> None:
    assert is_complete(written, FIRST)
    assert is_complete(written, SECOND)
    assert not is_complete(written, slice(SHARD, SHARD + 43))
    assert not is_complete(written, slice(SHARD, SHARD + 45))
    assert not is_complete(written / "nothing", FIRST)
    (written / "folder" / "c" / "0" / "0" / "0" / "0").mkdir(parents=True)
    assert not is_complete(written / "folder", FIRST)


def test_zarr_reads_what_is_written(tmp_path: Path) -> None:
    by_zarr(tmp_path)
    for rows in (FIRST, SECOND):
        file(tmp_path, rows).unlink()
    write_shards(tmp_path, ((rows, IMAGES[rows]) for rows in (FIRST, SECOND)))
    read = zarr.open_array(tmp_path, mode="r")
    np.testing.assert_array_equal(read[:], IMAGES)
    np.testing.assert_array_equal(read[270:272], IMAGES[270:272])


def test_shard_that_lacks_an_image_is_not_whole(tmp_path: Path) -> None:
    by_zarr(tmp_path, np.concatenate([IMAGES[:100], 0 * IMAGES[:1], IMAGES[101:]]))
    for number, rows in enumerate((FIRST, SECOND)):
        path = file(tmp_path, rows)
        content = path.read_bytes()
        index = np.frombuffer(content[-INDEX:-4], "<u8").reshape(SHARD, 2).copy()
        index[index[:, 1] < 2**63, 0] += 8
        head, tail = number.to_bytes(8, "little"), index.tobytes()
        path.write_bytes(head + content[:-INDEX] + tail + sharding._checksum(tail))
    assert not is_complete(tmp_path, FIRST)
    assert is_complete(tmp_path, SECOND)


def test_shards_that_have_changed_places_are_not_whole(tmp_path: Path) -> None:
    images = np.random.default_rng(1).integers(0, 256, (2 * SHARD, 1, 2, 3), dtype=np.uint8)
    first, second = shards(len(images))
    write_shards(tmp_path, ((rows, images[rows]) for rows in (first, second)))
    contents = [file(tmp_path, rows).read_bytes() for rows in (first, second)]
    assert len(contents[0]) == len(contents[1])
    for rows, content in zip((second, first), contents, strict=True):
        file(tmp_path, rows).write_bytes(content)
    assert not is_complete(tmp_path, first)
    assert not is_complete(tmp_path, second)


@given(data=st.data())
def test_what_is_cut_or_lengthened_or_has_another_index_is_not_whole(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    folder = tmp_path_factory.mktemp("shard")
    write_shards(folder, [(slice(0, 3), IMAGES[:3])])
    path = file(folder, slice(0, 3))
    sound = path.read_bytes()
    damage = data.draw(st.sampled_from(["cut", "lengthened", "index"]))
    if damage == "cut":
        first, last = sorted(data.draw(st.integers(0, len(sound))) for _ in range(2))
        damaged = sound[:first] + sound[last:]
    elif damage == "lengthened":
        at = data.draw(st.integers(0, len(sound)))
        damaged = sound[:at] + data.draw(st.binary(min_size=1)) + sound[at:]
    else:
        at = data.draw(st.integers(1, 16 * SHARD + 4))
        damaged = bytearray(sound)
        damaged[-at] ^= data.draw(st.integers(1, 255))
    path.write_bytes(damaged)
    assert is_complete(folder, slice(0, 3)) == (bytes(damaged) == sound)


def test_large_images_give_the_same_bytes_every_time(tmp_path: Path) -> None:
    """Blosc's own threads put the blocks of one image down in the order in which they are done."""
    images = np.repeat(np.random.default_rng(0).integers(0, 256, (4, 500, 200, 3), dtype=np.uint8), 8, axis=2)
    found = set()
    for attempt in range(10):
        write_shards(tmp_path / str(attempt), [(slice(0, 4), images)])
        found.add(file(tmp_path / str(attempt), slice(0, 4)).read_bytes())
    assert len(found) == 1


def test_next_shard_can_be_made_while_one_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made, real = threading.Event(), sharding._write

    def slow(path: Path, head: bytes, images: np.ndarray) -> None:
        assert made.wait(10)
        real(path, head, images)

    def making() -> Iterator[tuple[slice, np.ndarray]]:
        yield FIRST, IMAGES[FIRST]
        made.set()
        yield SECOND, IMAGES[SECOND]

    monkeypatch.setattr(sharding, "_write", slow)
    write_shards(tmp_path, making())
    assert is_complete(tmp_path, SECOND)


@pytest.mark.parametrize("more", [[], [FIRST]], ids=["at the end", "with the next shard"])
def test_what_cannot_be_written_leaves_nothing_and_is_told(tmp_path: Path, more: list[slice]) -> None:
    (tmp_path / "c" / "0").mkdir(parents=True)
    (tmp_path / "c" / "1").write_text("in the way")
    with pytest.raises(NotADirectoryError):
        write_shards(tmp_path, ((rows, IMAGES[rows]) for rows in (FIRST, SECOND, *more)))
    assert is_complete(tmp_path, FIRST)
    assert not list(tmp_path.rglob("*.partial"))


def test_what_fails_half_way_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_: bytes) -> bytes:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(sharding, "_checksum", full)
    with pytest.raises(OSError, match="No space left"):
        write_shards(tmp_path, [(FIRST, IMAGES[FIRST])])
    assert not [path for path in tmp_path.rglob("*") if path.is_file()]
