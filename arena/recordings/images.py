"""Pictures from anywhere, one after another: a folder, a video, files, arrays, or what makes them."""

import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import cv2
import google_crc32c
import numpy as np

from arena.errors import ArenaError
from arena.paths import user_path
from arena.recordings.colours import Picture, as_rgb
from arena.recordings.video import frame_rate, frames

SUFFIXES = (".bmp", ".jpeg", ".jpg", ".png", ".tif", ".tiff", ".webp")
"""Of pictures in a folder, in lower case."""


class Item(NamedTuple):
    """One picture that is not read yet."""

    label: str
    """What errors call it."""
    content: Any
    """A path, or an array of its own that nobody else writes to."""

    def read(self) -> tuple[int, Picture]:
        """Give a checksum of what it is made from, and the picture.

        Raises
        ------
        ArenaError
            When it cannot be read, or its numbers mean no colours.
        """
        if not isinstance(self.content, Path):
            return self.checksum(), as_rgb(self.content, self.label)
        data = _bytes(self.content)
        try:
            # 16 bit stay, alpha goes, and the camera is held upright.
            found = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR | cv2.IMREAD_ANYDEPTH)
        except cv2.error:  # of an empty file
            found = None
        if found is None:
            raise ArenaError(f"{self.label} is no picture that can be read; mend it, or leave it out")
        return google_crc32c.value(data), as_rgb(cv2.cvtColor(found, cv2.COLOR_BGR2RGB), self.label)

    def checksum(self) -> int:
        """Give the checksum alone, which takes far less time.

        Raises
        ------
        ArenaError
            When a file cannot be read.
        """
        if isinstance(self.content, Path):
            return int(google_crc32c.value(_bytes(self.content)))
        values = np.ascontiguousarray(self.content)
        shape = f"{values.dtype.str}{values.shape}".encode()
        return int(google_crc32c.extend(google_crc32c.value(shape), values.tobytes()))


class Pictures(NamedTuple):
    """Where pictures come from."""

    described: dict[str, Any]
    """What can be told of them, but their content; by it a source that has changed is known."""
    number: int | None
    """How many; None when only going through them tells."""
    rate: float | None
    """Frames a second, of a video that says it."""
    items: Callable[[], Iterator[Item]]


def pictures_of(source: Any) -> Pictures:
    """Find pictures.

    Parameters
    ----------
    source
        A folder, whose pictures come in natural order (`img2` before `img10`); a video; paths of pictures;
        arrays as `as_rgb` takes them, stacked or one by one; or an iterator of either, gone through once.

    Raises
    ------
    ArenaError
        When there are none.
    """
    if isinstance(source, str | Path):
        return _at(user_path(source))
    shape = getattr(source, "shape", None)
    if shape is not None and len(shape) != 1:
        return _stacked(source, tuple(shape))
    if shape is not None:  # a column of paths
        source = list(source)
    if isinstance(source, list | tuple):
        if not source:
            raise ArenaError("the list of pictures is empty; give at least one")
        names = [Path(one).name for one in source if isinstance(one, str | Path)]
        described = {"kind": "list", "pictures": len(source), "names": _names(names)}
        return Pictures(described, len(source), None, lambda: _one_by_one(source))
    if not isinstance(source, Iterable):
        raise ArenaError(
            f"{source!r} has no pictures; give a folder, a video, a list of files, an array or an iterator"
        )
    return Pictures({"kind": "iterator"}, None, None, lambda: _one_by_one(source))


def natural(name: str) -> tuple[list[str | int], str]:
    """Give a key by which numbers in names count as numbers.

    Examples
    --------
    >>> sorted(["img10.png", "img2.png"], key=natural)
    ['img2.png', 'img10.png']
    """
    # Words and numbers take turns, so that no word is compared with a number.
    parts = re.split(r"([0-9]+)", name.casefold())
    return [int(part) if index % 2 else part for index, part in enumerate(parts)], name


def _at(path: Path) -> Pictures:
    if path.is_dir():
        files = _inside(path)
        described = {
            "kind": "folder",
            "name": path.resolve().name,
            "pictures": len(files),
            "names": _names([file.name for file in files]),
        }
        return Pictures(described, len(files), None, lambda: _one_by_one(files))
    if not path.is_file():
        raise ArenaError(f"there is nothing at {path}; give a folder of pictures or a video")
    if path.suffix.lower() in SUFFIXES:
        return pictures_of([path])
    rate = frame_rate(path)
    described = {"kind": "video", "name": path.name, "bytes": path.stat().st_size}

    def shown() -> Iterator[Item]:
        return (Item(f"frame {number} of {path}", frame) for number, frame in enumerate(frames(path)))

    return Pictures(described, None, rate, shown)


def _inside(folder: Path) -> list[Path]:
    try:
        # Hidden files are not pictures, whatever they are called: `._img1.png` on disks that a Mac has seen.
        there = [file for file in folder.iterdir() if not file.name.startswith(".")]
    except OSError as error:
        raise ArenaError(f"cannot read {folder}: {error.strerror or error}") from None
    files = [file for file in there if file.suffix.lower() in SUFFIXES and file.is_file()]
    if not files:
        kinds = sorted({"folders" if item.is_dir() else item.suffix or item.name for item in there})
        found = f"only {', '.join(kinds[:5])}" if kinds else "it is empty"
        raise ArenaError(f"{folder} has no pictures ({found}); give a folder of {', '.join(SUFFIXES)}")
    return sorted(files, key=lambda file: natural(file.name))


def _stacked(source: Any, shape: tuple[int, ...]) -> Pictures:
    if len(shape) not in {3, 4} or not shape[0] or (len(shape) == 3 and shape[2] in {3, 4}):
        raise ArenaError(
            f"the pictures are of shape {shape}; give (views, height, width, 3), or (views, height, width) "
            "in grey"
        )
    described = {"kind": "array", "pictures": shape[0]}

    def rows() -> Iterator[Item]:
        return (Item(f"picture {number}", source[number]) for number in range(shape[0]))

    return Pictures(described, shape[0], None, rows)


def _one_by_one(source: Iterable[Any]) -> Iterator[Item]:
    for number, one in enumerate(source):
        if isinstance(one, str | Path):
            path = user_path(one)
            yield Item(str(path), path)
        else:
            # Whoever makes pictures may write the next one to the same memory.
            yield Item(f"picture {number}", np.array(one))


def _names(names: list[str]) -> int:
    return int(google_crc32c.value("\n".join(names).encode(errors="surrogateescape")))


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise ArenaError(f"cannot read {path}: {error.strerror or error}") from None
