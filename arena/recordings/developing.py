"""Developing: pictures become views in threads, a few ahead of where they are needed."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from itertools import chain
from typing import Any, TypeVar

import numba
from tqdm import tqdm

from arena.errors import ArenaError
from arena.recordings.beside import Beside
from arena.recordings.colours import Picture
from arena.recordings.images import Item, Pictures
from arena.recordings.lens import Lens, Look
from arena.recordings.sharding import encoded

T = TypeVar("T")


@dataclass(frozen=True)
class Darkroom:
    """Makes views of pictures, which must all have the size of the first."""

    first: str
    size: tuple[int, int]
    look: Look
    shape: tuple[int, int, int]
    """Of a view."""
    camera: dict[str, Any]

    def develop(self, item: Item) -> tuple[int, Picture]:
        """Give a checksum of what a picture is made from, and its view."""
        checksum, picture = item.read()
        if picture.shape[:2] != self.size:
            (height, width), (rows, columns) = picture.shape[:2], self.size
            raise ArenaError(
                f"{item.label} has {width}×{height} pixels and {self.first} {columns}×{rows}; "
                "all must be of one size: resize it, or leave it out"
            )
        return checksum, self.look(picture)

    def pack(self, item: Item) -> tuple[int, bytes]:
        """Give a checksum of what a picture is made from, and its view as it stands in a shard."""
        checksum, view = self.develop(item)
        return checksum, encoded(view)


def opened(
    pictures: Pictures, lens: Lens, beside: Beside, *, progress: bool
) -> tuple[Darkroom, Iterator[Item]]:
    """Look at the first picture, and refuse before anything is made what can be refused by then.

    Raises
    ------
    ArenaError
        When there is none, or it does not go together with the lens, nor their number with the tables.
    """
    if pictures.number is not None:
        beside.matched(pictures.number, pictures.rate)
    items = pictures.items()
    first = next(items, None)
    if first is None:
        raise ArenaError("there are no pictures: the source ends before the first; give at least one")
    picture = first.read()[1]
    height, width = picture.shape[:2]
    look = lens.fitted(height, width)
    rows, columns, colours = look(picture).shape
    darkroom = Darkroom(
        first.label, (height, width), look, (rows, columns, colours), lens.camera(rows, columns)
    )
    all_items = chain([first], items)
    return darkroom, iter(tqdm(all_items, total=pictures.number, unit="view", disable=not progress))


def in_order(pool: ThreadPoolExecutor, work: Callable[[Item], T], items: Iterable[Item]) -> Iterator[T]:
    """Work on items in threads, a few ahead of what is asked for, which comes in order."""
    waiting = deque[Future[T]]()
    for item in items:
        waiting.append(pool.submit(work, item))
        del item  # or the picture would stay until the next one is there
        if len(waiting) > 2 * numba.get_num_threads():
            yield waiting.popleft().result()
    while waiting:
        yield waiting.popleft().result()
