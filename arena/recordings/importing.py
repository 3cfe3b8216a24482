"""Importing: pictures become views, in memory or on disk shard by shard, where a kill loses but the last."""

import json
import shutil
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import chain, count, islice
from pathlib import Path
from typing import Any, NamedTuple

import cv2
import google_crc32c
import numba
import numpy as np
from jaxtyping import UInt8

from arena.atomic import sync
from arena.errors import ArenaError
from arena.recordings import storage
from arena.recordings.begun import BEGUN, Begun, note
from arena.recordings.beside import Beside
from arena.recordings.developing import Darkroom, in_order, opened
from arena.recordings.images import Item, Pictures
from arena.recordings.lens import Lens
from arena.recordings.resuming import refuse_another
from arena.recordings.sharding import SHARD, is_complete, write_frames


class Imported(NamedTuple):
    """What makes a recording."""

    views: UInt8[np.ndarray, "views height width 3"]
    columns: dict[str, np.ndarray]
    attributes: dict[str, Any]


def import_to_memory(pictures: Pictures, lens: Lens, beside: Beside, *, progress: bool = False) -> Imported:
    """Make views of pictures.

    Raises
    ------
    ArenaError
        For pictures or tables that cannot be read or do not go together.
    """
    darkroom, items = opened(pictures, lens, beside, progress=progress)
    with ThreadPoolExecutor(numba.get_num_threads()) as pool:
        made = (view for _, view in in_order(pool, darkroom.develop, items))
        # As they come: a list of all, and their array, would be there at once.
        kind = np.dtype((np.uint8, darkroom.shape))
        views = np.fromiter(made, kind, -1 if pictures.number is None else pictures.number)
    columns, notes = beside.matched(len(views), pictures.rate)
    attributes = {
        **_described(pictures, lens),
        "camera": darkroom.camera,
        "beside": notes,
        "views": len(views),
    }
    return Imported(views, columns, attributes)


def import_to_disk(
    pictures: Pictures, lens: Lens, beside: Beside, path: Path, *, progress: bool = False
) -> None:
    """Make views of pictures into a folder, 256 at a time; only a few of them are in memory.

    What is there of an import that was killed is compared with its pictures, by checksums, and gone on with.
    The tables come last, and are compared when all is there.

    Raises
    ------
    ArenaError
        For pictures or tables that cannot be read or do not go together, for an import that was begun of
        others or by another lens, for anything else at the path, and when it cannot be written.
    """
    darkroom, items = opened(pictures, lens, beside, progress=progress)
    wanted = _described(pictures, lens)
    begun = Begun.at(path, wanted)
    try:
        views = sum(_stream(path, begun, wanted, darkroom, _of_source(items)))
        columns, notes = beside.matched(views, pictures.rate)
        attributes = {**wanted, "camera": darkroom.camera, "beside": notes, "views": views}
        attributes |= {"shards": begun.shards}
        if begun.whole is None:
            _finish(path, (views, *darkroom.shape), columns, attributes)
        elif not _equal(begun.whole, columns, attributes):
            refuse_another(path, {"table beside it": "that"}, {"table beside it": "this"})
    except OSError as error:
        raise ArenaError(
            f"cannot write {path}: {error.strerror or error}; what is written is kept, and the same command "
            "goes on from there"
        ) from None
    except _SourceFailedError as failed:
        raise failed.error from None


def _described(pictures: Pictures, lens: Lens) -> dict[str, Any]:
    """Tell of what must stay the same for an import to go on, as it will read back from JSON."""
    told = {"source": pictures.described, "lens": lens.model_dump(), "opencv": cv2.__version__}
    read_back: dict[str, Any] = json.loads(json.dumps(told))
    return read_back


def _stream(
    path: Path, begun: Begun, wanted: dict[str, Any], darkroom: Darkroom, items: Iterator[Item]
) -> Iterator[int]:
    """Write shard after shard, or see that they are there; give how many views each has."""
    shards, views, folder = begun.shards, begun.views, path / "views"
    with ThreadPoolExecutor(numba.get_num_threads()) as pool:
        for number in count():
            here = _some(items, SHARD)
            if here is None:
                break
            first, known = number * SHARD, shards[number] if number < len(shards) else None
            if known is None and begun.whole is not None:
                raise ArenaError(_CHANGED.format(path=path))
            rows = slice(first, first + SHARD if known is None else min(first + SHARD, views))
            sum_ = _Sum(path, known)
            if known is not None and is_complete(folder, rows):
                deque(sum_.over(in_order(pool, _checked, here)), maxlen=0)
            else:
                write_frames(folder, rows, sum_.over(in_order(pool, darkroom.pack, here)))
            if known is None:
                shards.append(sum_.checksum)
                views += sum_.views
                note(path, wanted, shards, views)
            yield sum_.views
    if number < len(shards):
        raise ArenaError(_CHANGED.format(path=path))


_CHANGED = (
    "{path} was begun from other pictures than those that come now; give the same ones, choose another path, "
    "or remove it first"
)


def _checked(item: Item) -> tuple[int, bytes]:
    """Read a picture for its checksum alone."""
    return item.checksum(), b""


@dataclass
class _Sum:
    """Counts the pictures of a shard, and sums up their checksums."""

    path: Path
    known: int | None
    """What the sum must be."""
    views: int = 0
    checksum: int = 0

    def over(self, made: Iterable[tuple[int, bytes]]) -> Iterator[bytes]:
        """Hand on what is made; a shard of other pictures than before is refused before it has its name."""
        for checksum, frame in made:
            self.views += 1
            self.checksum = int(google_crc32c.extend(self.checksum, checksum.to_bytes(4, "little")))
            yield frame
        if self.known is not None and self.checksum != self.known:
            raise ArenaError(_CHANGED.format(path=self.path))


def _some(items: Iterator[Item], most: int) -> Iterator[Item] | None:
    """Give the next items, not more than so many; None when there are none."""
    first = next(items, None)
    return None if first is None else chain([first], islice(items, most - 1))


class _SourceFailedError(Exception):
    """Carries what the source itself raised past those who take it for a failure to write."""

    def __init__(self, error: OSError) -> None:
        super().__init__(error)
        self.error = error


def _of_source(items: Iterator[Item]) -> Iterator[Item]:
    try:
        yield from items
    except OSError as error:
        raise _SourceFailedError(error) from None


def _finish(
    path: Path, shape: tuple[int, ...], columns: dict[str, np.ndarray], attributes: dict[str, Any]
) -> None:
    """Describe what is there: from then on it is a recording."""
    for item in (*path.iterdir(), path / "views" / "zarr.json"):  # of one who was killed just here
        if item.name not in {"views", BEGUN}:
            shutil.rmtree(item, ignore_errors=True)
            item.unlink(missing_ok=True)
    storage.describe(path, shape, columns, attributes)
    sync(path)
    (path / BEGUN).unlink()


def _equal(stored: storage.Stored, columns: dict[str, np.ndarray], attributes: dict[str, Any]) -> bool:
    """Whether a recording has these arrays, and came by them in the same way."""
    same = stored.columns.keys() == columns.keys() and stored.attributes["beside"] == attributes["beside"]
    return same and all(np.array_equal(stored.columns[name], columns[name]) for name in columns)
