"""Shards of a zarr array, written whole and without zarr, whose own way takes 0.3 ms of overhead an image."""

import os
from collections.abc import Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import google_crc32c
import numpy as np
from jaxtyping import UInt8, UInt64
from numcodecs import Blosc
from zarr.codecs import BloscCodec, Crc32cCodec

from arena.atomic import atomic_write

SHARD = 256
"""Views in a file."""


def codecs() -> tuple[BloscCodec, Crc32cCodec]:
    """Describe to zarr how an image is compressed, and that a checksum follows it.

    lz4 is ten times as fast as zstd at its level 3, for a quarter more bytes.
    """
    return BloscCodec(cname="lz4", clevel=9, shuffle="noshuffle", typesize=1), Crc32cCodec()


def shards(count: int) -> list[slice]:
    """Cut this many views into shards."""
    return [slice(first, min(first + SHARD, count)) for first in range(0, count, SHARD)]


def file(folder: Path, rows: slice) -> Path:
    """Tell where a shard of the array in this folder lies."""
    return folder / "c" / str(rows.start // SHARD) / "0" / "0" / "0"


def is_complete(path: Path, count: int) -> bool:
    """Whether a shard of this many images is there, to its last byte."""
    length = 16 * SHARD + 4
    if not path.is_file() or path.stat().st_size < length:
        return False
    with path.open("rb") as stream:
        stream.seek(-length, os.SEEK_END)
        index, checksum = stream.read(length - 4), stream.read(4)
    sizes = np.frombuffer(index, "<u8").reshape(SHARD, 2)[:count, 1]
    return checksum == _checksum(index) and path.stat().st_size == int(sizes.sum()) + length


class Writer:
    """Puts images into the folder of an array, a shard at a time; `shard_writer` makes one.

    `writer[rows] = images` compresses and writes a shard while the next one is made; `rows` come from
    `shards`. The file takes its name when it is whole.
    """

    def __init__(self, folder: Path, worker: Executor) -> None:
        self._folder = folder
        self._worker = worker
        self._last: Future[None] | None = None

    def __setitem__(self, rows: slice, images: UInt8[np.ndarray, "views height width 3"]) -> None:
        self.finish()
        self._last = self._worker.submit(_write, file(self._folder, rows), images)

    def finish(self) -> None:
        """Wait for what is being written."""
        if self._last is not None:
            self._last.result()


@contextmanager
def shard_writer(folder: Path) -> Iterator[Writer]:
    """Write images into the folder of an array.

    Raises
    ------
    OSError
        When a shard cannot be written, from the next one or at the end; those before it stay.
    """
    # Blosc makes the same bytes every time only when it is not called from the main thread.
    with ThreadPoolExecutor(1) as worker:
        writer = Writer(folder, worker)
        yield writer
        writer.finish()


def _write(path: Path, images: np.ndarray) -> None:
    described = codecs()[0]
    blosc = Blosc(described.cname.value, described.clevel, Blosc.NOSHUFFLE)
    frames: list[bytes] = [blosc.encode(image) for image in np.ascontiguousarray(images)]
    frames = [frame + _checksum(frame) for frame in frames]
    index = _index(np.array([len(frame) for frame in frames], "<u8")).tobytes()
    with atomic_write(path) as fresh, fresh.open("wb") as stream:
        stream.writelines([*frames, index, _checksum(index)])


def _index(sizes: UInt64[np.ndarray, " images"]) -> UInt64[np.ndarray, "shard 2"]:
    """Offset and size of every image that a shard has room for; all ones where none is."""
    index = np.full((SHARD, 2), 2**64 - 1, "<u8")
    index[: len(sizes)] = np.stack([np.cumsum(sizes) - sizes, sizes], axis=1)
    return index


def _checksum(content: bytes) -> bytes:
    return int(google_crc32c.value(content)).to_bytes(4, "little")
