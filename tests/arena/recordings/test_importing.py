import errno
import gc
import json
import os
import shutil
import signal
import subprocess
import sys
import tracemalloc
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cv2
import numba
import numpy as np
import pytest

from arena.errors import ArenaError
from arena.recordings import sharding, storage
from arena.recordings.begun import BEGUN, unfinished
from arena.recordings.recording import Recording
from arena.recordings.sharding import file

VIEWS = 700
FRAMES = np.random.default_rng(0).integers(0, 256, (VIEWS, 8, 12, 3), dtype=np.uint8)
SIGNALS = {"gas": np.linspace(1, 2, VIEWS)}


def snapshot(path: Path) -> dict[str, bytes]:
    return {
        str(item.relative_to(path)): item.read_bytes() for item in sorted(path.rglob("*")) if item.is_file()
    }


def until(last: int, error: Exception) -> Iterator[np.ndarray]:
    """Give frames up to one, where the source fails."""
    yield from FRAMES[:last]
    raise error


def begin(path: Path, last: int = 600) -> None:
    with pytest.raises(KeyError):
        Recording.from_images(until(last, KeyError("out of frames")), out=path, signals=SIGNALS)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("whole") / "rec.zarr"
    Recording.from_images(iter(FRAMES), out=path, signals=SIGNALS)
    return path


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("frames")
    for number, frame in enumerate(FRAMES[:300]):
        cv2.imwrite(str(path / f"{number}.png"), frame[..., ::-1])
    return path


@pytest.mark.parametrize("kind", ["array", "list", "iterator", "generator"])
def test_on_disk_is_the_same_as_in_memory(tmp_path: Path, kind: str) -> None:
    def source() -> Any:
        kinds = {
            "array": FRAMES,
            "list": list(FRAMES),
            "iterator": iter(FRAMES),
            "generator": (f for f in FRAMES),
        }
        return kinds[kind]

    memory = Recording.from_images(source(), signals=SIGNALS, rate=5)
    disk = Recording.from_images(source(), signals=SIGNALS, rate=5, out=tmp_path / "new" / "rec.zarr")
    np.testing.assert_array_equal(memory.views, FRAMES)
    np.testing.assert_array_equal(disk.views[:], FRAMES)
    for rec in (memory, disk):
        np.testing.assert_array_equal(rec.times, np.arange(VIEWS) / 5)
        np.testing.assert_array_equal(rec.require("odours")[:, 0], SIGNALS["gas"].astype(np.float32))
        np.testing.assert_array_equal(rec.signals["gas"], SIGNALS["gas"])
        assert (rec.poses, rec.commands) == (None, None)
        with pytest.raises(ArenaError, match="has no poses"):
            rec.require("poses")
    assert memory.attributes.items() <= disk.attributes.items()
    assert disk.attributes["views"] == VIEWS


def test_smaller_views_and_what_camera_would_take_them(tmp_path: Path) -> None:
    options = {"kind": "cylindrical", "width": 6, "ahead": 180}
    memory = Recording.from_images(FRAMES, **options)
    disk = Recording.from_images(FRAMES, **options, out=tmp_path / "rec.zarr")
    turned = np.roll(FRAMES, 6, axis=2)
    means = turned.reshape(VIEWS, 4, 2, 6, 2, 3).mean(axis=(2, 4))
    assert np.abs(memory.views - means).max() <= 0.5
    np.testing.assert_array_equal(disk.views[:], memory.views)
    assert disk.attributes["camera"]["projection"] == "panoramic"
    assert disk.attributes["camera"]["width"] == 6


def test_threads_change_no_bit(tmp_path: Path, whole: Path) -> None:
    before = numba.get_num_threads()
    try:
        numba.set_num_threads(1)
        Recording.from_images(iter(FRAMES), out=tmp_path / "rec.zarr", signals=SIGNALS)
    finally:
        numba.set_num_threads(before)
    assert snapshot(tmp_path / "rec.zarr") == snapshot(whole)


KILLED = """
import os, signal, sys
import numpy as np
from arena.recordings.recording import Recording
frames = np.load(sys.argv[1])
def camera():
    yield from frames[:600]
    os.kill(os.getpid(), signal.SIGKILL)
Recording.from_images(camera(), out=sys.argv[2], signals={"gas": np.linspace(1, 2, len(frames))})
"""


def test_killed_it_goes_on_at_the_last_whole_shard_and_ends_with_the_same_bits(
    tmp_path: Path, whole: Path
) -> None:
    np.save(tmp_path / "frames.npy", FRAMES)
    path = tmp_path / "rec.zarr"
    command = [sys.executable, "-c", KILLED, tmp_path / "frames.npy", path]
    assert subprocess.run(command, check=False, cwd=Path(__file__).parents[3]).returncode == -signal.SIGKILL
    assert list(path.rglob("*.partial")) + list(path.rglob(".*")), "nothing was being written"
    with pytest.raises(ArenaError, match="is half-written: 512 views are there; the same `import` command"):
        Recording.open(path)
    there = [file(path / "views", slice(first, first + 256)) for first in (0, 256)]
    before = [(shard.stat().st_ino, shard.stat().st_mtime_ns) for shard in there]
    Recording.from_images(iter(FRAMES), out=path, signals=SIGNALS)
    assert [(shard.stat().st_ino, shard.stat().st_mtime_ns) for shard in there] == before
    assert snapshot(path) == snapshot(whole)


@pytest.mark.parametrize("last", [0, 1, 255, 256, 600, 699, 700])
def test_a_source_that_fails_leaves_whole_shards(tmp_path: Path, whole: Path, last: int) -> None:
    path = tmp_path / "rec.zarr"
    begin(path, last)
    if last:
        assert json.loads((path / BEGUN).read_text())["views"] == last // 256 * 256
    assert not list(path.rglob("*.partial"))
    Recording.from_images(iter(FRAMES), out=path, signals=SIGNALS)
    assert snapshot(path) == snapshot(whole)


def test_killed_while_it_is_described(tmp_path: Path, whole: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "rec.zarr"

    def half(folder: Path, *rest: Any) -> None:
        describe(folder, *rest)
        (folder / "times" / "zarr.json").write_text("half")
        raise KeyboardInterrupt

    describe = storage.describe
    monkeypatch.setattr(storage, "describe", half)
    with pytest.raises(KeyboardInterrupt):
        Recording.from_images(iter(FRAMES), out=path, signals=SIGNALS)
    monkeypatch.undo()
    with pytest.raises(ArenaError, match="half-written: 700 views"):
        Recording.open(path)
    Recording.from_images(iter(FRAMES), out=path, signals=SIGNALS)
    assert snapshot(path) == snapshot(whole)


def test_only_what_is_not_there_is_made(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, paths = tmp_path / "rec.zarr", sorted(folder.iterdir())
    Recording.from_images(paths, out=path)
    before, read = snapshot(path), list[Path]()
    imdecode = cv2.imdecode
    monkeypatch.setattr(cv2, "imdecode", lambda *all_: read.append(all_[0]) or imdecode(*all_))
    Recording.from_images(paths, out=path)
    assert len(read) == 1  # the first, for the size
    file(path / "views", slice(256, 300)).unlink()
    with pytest.raises(ArenaError, match="256 of its 300 views are there; the same `import` command"):
        Recording.open(path)
    Recording.from_images(paths, out=path)
    assert len(read) == 1 + 1 + 44
    assert snapshot(path) == before


def changed(frame: int) -> np.ndarray:
    frames = FRAMES.copy()
    frames[frame, 3, 5, 1] ^= 1
    return frames


@pytest.mark.parametrize(
    "frames", [changed(0), changed(511), FRAMES[1:], FRAMES[:500], FRAMES[:512], FRAMES[:3]], ids=len
)
def test_another_source_is_refused(tmp_path: Path, frames: np.ndarray) -> None:
    path = tmp_path / "rec.zarr"
    begin(path)
    before = snapshot(path)
    if len(frames) == 512:  # all that was seen, and no more
        assert len(Recording.from_images(iter(frames), out=path)) == 512
        return
    with pytest.raises(
        ArenaError, match="was begun from other pictures than those that come now; give the same"
    ):
        Recording.from_images(iter(frames), out=path, signals={"gas": SIGNALS["gas"][: len(frames)]})
    assert snapshot(path) == before


@pytest.mark.parametrize(
    "frames", [changed(650), FRAMES[:512], np.concatenate([FRAMES, FRAMES[:1]])], ids=len
)
def test_another_source_than_that_of_a_whole_recording(
    tmp_path: Path, whole: Path, frames: np.ndarray
) -> None:
    path = tmp_path / "rec.zarr"
    shutil.copytree(whole, path)
    with pytest.raises(ArenaError, match="was begun from other pictures"):
        Recording.from_images(iter(frames), out=path, signals=SIGNALS)
    file(path / "views", slice(512, 700)).unlink()
    with pytest.raises(ArenaError, match="was begun from other pictures"):
        Recording.from_images(iter(frames), out=path, signals=SIGNALS)
    assert not file(path / "views", slice(512, 700)).exists()


def test_a_source_that_ends_with_a_shard_and_has_grown(tmp_path: Path) -> None:
    Recording.from_images(iter(FRAMES[:256]), out=tmp_path / "rec.zarr")
    before = snapshot(tmp_path / "rec.zarr")
    with pytest.raises(ArenaError, match="was begun from other pictures"):
        Recording.from_images(iter(FRAMES[:257]), out=tmp_path / "rec.zarr")
    assert snapshot(tmp_path / "rec.zarr") == before


@pytest.mark.parametrize("done", [True, False])
def test_another_lens_or_table_is_refused(tmp_path: Path, whole: Path, done: bool) -> None:  # noqa: FBT001
    path = tmp_path / "rec.zarr"
    shutil.copytree(whole, path) if done else begin(path)
    before = snapshot(path)
    for options in ({"width": 6}, {"kind": "perspective"}):
        with pytest.raises(
            ArenaError, match="holds another recording, of a different lens; choose another path"
        ):
            Recording.from_images(iter(FRAMES), out=path, signals=SIGNALS, **options)
    with pytest.raises(ArenaError, match="of a different source;"):
        Recording.from_images(FRAMES, out=path, signals=SIGNALS)
    if done:
        for options in ({}, {"signals": SIGNALS, "rate": 2}, {"signals": {"gas": SIGNALS["gas"] + 1}}):
            with pytest.raises(ArenaError, match="of a different table beside it;"):
                Recording.from_images(iter(FRAMES), out=path, **options)
    assert snapshot(path) == before
    Recording.from_images(iter(FRAMES), out=path, signals=SIGNALS)


def test_tables_can_be_mended_until_it_is_whole(tmp_path: Path, whole: Path) -> None:
    path = tmp_path / "rec.zarr"
    with pytest.raises(ArenaError, match="has 9 rows for 700 pictures"):
        Recording.from_images(iter(FRAMES), out=path, signals={"gas": np.ones(9)})
    with pytest.raises(ArenaError, match="half-written: 700 views"):
        Recording.open(path)
    Recording.from_images(iter(FRAMES), out=path, signals=SIGNALS)
    assert snapshot(path) == snapshot(whole)


def test_what_can_be_refused_at_once_leaves_nothing(tmp_path: Path, folder: Path) -> None:
    path = tmp_path / "rec.zarr"
    for source, options in [
        (FRAMES, {"signals": {"gas": np.ones(9)}}),
        (FRAMES, {"kind": "equirectangular"}),
        (iter(()), {}),
        (folder, {"times": [0, 1]}),
        ([np.zeros((2, 2))], {"rate": -1}),
    ]:
        with pytest.raises(ArenaError):
            Recording.from_images(source, out=path, **options)
    assert not list(tmp_path.iterdir())


def test_pictures_of_other_sizes_and_broken_ones_are_named(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder, tmp_path / "frames")
    cv2.imwrite(str(tmp_path / "frames" / "290.png"), np.zeros((12, 8, 3), np.uint8))
    for out in (None, tmp_path / "rec.zarr"):
        with pytest.raises(
            ArenaError, match=r"290\.png has 8×12 pixels and .*/0\.png 12×8; all must be of one size"
        ):
            Recording.from_images(tmp_path / "frames", out=out)
    (tmp_path / "frames" / "290.png").write_bytes(b"")
    with pytest.raises(ArenaError, match=r"290\.png is no picture"):
        Recording.from_images(tmp_path / "frames", out=tmp_path / "rec.zarr")
    shutil.copy(folder / "290.png", tmp_path / "frames")
    rec = Recording.from_images(tmp_path / "frames", out=tmp_path / "rec.zarr")
    np.testing.assert_array_equal(rec.views[:], FRAMES[:300])
    with pytest.raises(ArenaError, match="picture 1 has 3×3 pixels and picture 0 2×2"):
        Recording.from_images([np.zeros((2, 2)), np.zeros((3, 3))])


@pytest.mark.parametrize("kind", ["file", "folder", "recording"])
def test_nothing_else_is_touched(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "rec.zarr"
    if kind == "recording":
        Recording(views=FRAMES, times=np.arange(VIEWS, dtype=float)).save(path)
    elif kind == "folder":
        path.mkdir()
        (path / "mine").write_text("mine")
    else:
        path.write_text("mine")
    before = snapshot(tmp_path)
    words = "holds another recording, of a different source" if kind == "recording" else "is not a recording"
    with pytest.raises(ArenaError, match=words):
        Recording.from_images(iter(FRAMES), out=path)
    assert snapshot(tmp_path) == before


@pytest.mark.parametrize(
    "content", ["", "7", "{}", '{"shards": [1], "views": 999}', '{"shards": 3, "views": 9}']
)
def test_damaged_notes(tmp_path: Path, content: str) -> None:
    path = tmp_path / "rec.zarr"
    begin(path)
    (path / BEGUN).write_text(content)
    for call in (lambda: Recording.open(path), lambda: Recording.from_images(iter(FRAMES), out=path)):
        with pytest.raises(ArenaError, match=r"begun\.json is damaged; remove .* and import again"):
            call()


def test_a_disk_that_fills_up_loses_nothing(
    tmp_path: Path, whole: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, real = tmp_path / "rec.zarr", sharding._write

    def full(file: Path, head: Any, frames: Any) -> None:
        if "1" in file.parts:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        real(file, head, frames)

    monkeypatch.setattr(sharding, "_write", full)
    with pytest.raises(
        ArenaError, match="No space left on device; what is written is kept, and the same command"
    ):
        Recording.from_images(iter(FRAMES), out=path, signals=SIGNALS)
    monkeypatch.undo()
    assert unfinished(path) == 256
    Recording.from_images(iter(FRAMES), out=path, signals=SIGNALS)
    assert snapshot(path) == snapshot(whole)


def test_what_the_source_raises_is_not_taken_for_a_full_disk(tmp_path: Path) -> None:
    with pytest.raises(ConnectionResetError, match="camera unplugged"):
        Recording.from_images(until(300, ConnectionResetError("camera unplugged")), out=tmp_path / "rec.zarr")


def test_memory_is_that_of_a_few_pictures(tmp_path: Path) -> None:
    """However many there are: a shard alone would be 256 of them."""
    size, alive = 64 * 96 * 3, list[int]()

    def camera() -> Iterator[np.ndarray]:
        for _ in range(400):
            alive.append(tracemalloc.get_traced_memory()[0])
            yield rng.integers(0, 256, (64, 96, 3), dtype=np.uint8)

    rng = np.random.default_rng(0)
    Recording.from_images(iter(FRAMES[:2]), out=tmp_path / "warm.zarr")
    gc.collect()
    tracemalloc.start()
    try:
        before = tracemalloc.get_traced_memory()[0]
        Recording.from_images(camera(), out=tmp_path / "rec.zarr")
        peak = tracemalloc.get_traced_memory()[1] - before
    finally:
        tracemalloc.stop()
    held = 6 * numba.get_num_threads() + 10
    # Files are written by the megabyte, and indices are a number each.
    assert peak < held * size + 2**21 + 2**19
    assert max(alive[300:]) - max(alive[100:250]) < 20 * size
