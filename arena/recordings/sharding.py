"""Shards of a zarr array, written and read without zarr, whose own way takes 0.3 ms of overhead an image."""

import os
from collections.abc import Iterable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import BinaryIO

import google_crc32c
import numpy as np
from jaxtyping import Int, UInt8
from numcodecs import Blosc
from zarr.codecs import BloscCodec, Crc32cCodec

from arena.atomic import atomic_write

SHARD = 256
"""Views in a file."""
_HEAD = 8
"""Bytes at its beginning: which shard it is. The index leaves them out, so that zarr does, too."""
_INDEX = 16 * SHARD + 4
"""Bytes at its end: offset and size of every view, and a checksum."""


def codecs() -> tuple[BloscCodec, Crc32cCodec]:
    """Describe to zarr how an image is compressed, and that a checksum follows it.

    lz4 is ten times as fast as zstd at its level 3, for a quarter more bytes.
    """
    return BloscCodec(cname="lz4", clevel=9, shuffle="noshuffle", typesize=1), Crc32cCodec()


_BLOSC = Blosc(codecs()[0].cname.value, codecs()[0].clevel, Blosc.NOSHUFFLE)


def shards(count: int) -> list[slice]:
    """Cut this many views into shards."""
    return [slice(first, min(first + SHARD, count)) for first in range(0, count, SHARD)]


def file(folder: Path, rows: slice) -> Path:
    """Tell where a shard of the array in this folder lies."""
    return folder / "c" / str(rows.start // SHARD) / "0" / "0" / "0"


def is_complete(folder: Path, rows: slice) -> bool:
    """Whether a shard of the array in this folder is there, to its last byte, and no other in its place."""
    path = file(folder, rows)
    if not path.is_file() or path.stat().st_size < _HEAD + _INDEX:
        return False
    with path.open("rb") as stream:
        return _places(stream, rows) is not None


def read_images(
    folder: Path, rows: slice, chosen: Int[np.ndarray, " chosen"], out: Sequence[np.ndarray]
) -> None:
    """Read images of a shard of the array in this folder, numbered from its first one, into buffers.

    Raises
    ------
    OSError, ValueError, RuntimeError
        When the file is not there, not whole, or an image is no longer what was written.
    """
    blosc = Blosc()
    with file(folder, rows).open("rb") as stream:
        places = _places(stream, rows)
        if places is None:
            raise ValueError("the file is not whole")
        for number, image, (offset, size) in zip(chosen, out, places[chosen].tolist(), strict=True):
            stream.seek(offset)
            frame = stream.read(size)
            if _checksum(frame[:-4]) != frame[-4:]:
                raise ValueError(f"view {rows.start + number} does not match its checksum")
            blosc.decode(frame[:-4], image)


def _places(stream: BinaryIO, rows: slice) -> Int[np.ndarray, "shard 2"] | None:
    """Give offset and size of every image of a shard; None when it is not whole, or another one."""
    is_this = stream.read(_HEAD) == _head(rows)
    whole = stream.seek(0, os.SEEK_END)
    stream.seek(-_INDEX, os.SEEK_END)
    index, checksum = stream.read(_INDEX - 4), stream.read(4)
    places = np.frombuffer(index, "<u8").reshape(SHARD, 2)[: rows.stop - rows.start].astype(np.int64)
    is_whole = checksum == _checksum(index) and whole == _HEAD + places[:, 1].sum() + _INDEX
    return places if is_this and is_whole else None


def write_shards(
    folder: Path, views: Iterable[tuple[slice, UInt8[np.ndarray, "shard height width 3"]]]
) -> None:
    """Write images into the folder of an array, each shard while the next one is made.

    Parameters
    ----------
    folder
        Of the array. A file in it takes its name when it is whole.
    views
        Rows, as `shards` cuts them, and their images.

    Raises
    ------
    OSError
        When a shard cannot be written, with the next one or at the end; those before it stay.
    """
    last: Future[None] | None = None
    # Blosc makes the same bytes every time only when it is not called from the main thread.
    with ThreadPoolExecutor(1) as worker:
        for rows, images in views:
            if last is not None:
                last.result()
            last = worker.submit(write_shard, folder, rows, images)
        if last is not None:
            last.result()


def write_shard(folder: Path, rows: slice, images: UInt8[np.ndarray, "shard height width 3"]) -> None:
    """Write one shard; see `write_shards`, and call it from any thread but the main one."""
    write_frames(folder, rows, map(encoded, np.ascontiguousarray(images)))


def write_frames(folder: Path, rows: slice, frames: Iterable[bytes]) -> None:
    """Write one shard of `encoded` images as they come; what their source raises leaves none."""
    _write(file(folder, rows), _head(rows), frames)


def encoded(image: UInt8[np.ndarray, "height width 3"]) -> bytes:
    """Give a C-contiguous image as it stands in a shard; call it from any thread but the main one."""
    frame: bytes = _BLOSC.encode(image)
    return frame + _checksum(frame)


def _write(path: Path, head: bytes, frames: Iterable[bytes]) -> None:
    sizes = list[int]()
    # Frames go out by the megabyte: a call of the system for each would take as long as its checksum.
    with atomic_write(path) as fresh, fresh.open("wb", buffering=2**20) as stream:
        stream.write(head)
        sizes.extend(map(stream.write, frames))
        # Offset and size of every image that a shard has room for; all ones where none is.
        index = np.full((SHARD, 2), 2**64 - 1, "<u8")
        index[: len(sizes)] = np.stack([_HEAD + np.cumsum(sizes) - sizes, sizes], axis=1)
        stream.writelines([index.tobytes(), _checksum(index.tobytes())])


def _head(rows: slice) -> bytes:
    return int(rows.start // SHARD).to_bytes(_HEAD, "little")


def _checksum(content: bytes) -> bytes:
    return int(google_crc32c.value(content)).to_bytes(4, "little")
