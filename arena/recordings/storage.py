"""Storage of a recording on disk: a zarr 3 group of named arrays with checksums, the views in shards."""

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import zarr
from jaxtyping import Int, UInt8
from zarr.codecs import Crc32cCodec

from arena.atomic import atomic_write
from arena.errors import ArenaError
from arena.recordings.digests import checksum, digest
from arena.recordings.sharding import SHARD, codecs, file, is_complete, read_images, shards
from arena.settings import plain

VERSION = 4
"""Of the layout."""

DAMAGE = (OSError, ValueError, LookupError, TypeError, AttributeError, RuntimeError, ArithmeticError)
"""What zarr has been seen to raise on damaged metadata and chunks."""


class StoredViews:
    """Views on disk, indexed like a numpy array: what is asked for is read and compared with its checksum.

    Parameters
    ----------
    folder
        Of the array.
    shape
        Of all of them.
    chosen
        Which of them, by their numbers on disk; all when None.
    """

    def __init__(
        self, folder: Path, shape: tuple[int, ...], chosen: Int[np.ndarray, " chosen"] | None = None
    ) -> None:
        self._folder, self._written = folder, shape
        self._numbers = np.arange(shape[0]) if chosen is None else chosen
        self.shape = (len(self._numbers), *shape[1:])
        self.dtype = np.dtype(np.uint8)
        self.ndim = len(shape)

    def only(self, chosen: Int[np.ndarray, " chosen"]) -> "StoredViews":
        """Give some of them, by their numbers on disk."""
        return StoredViews(self._folder, self._written, chosen)

    def __len__(self) -> int:
        return self.shape[0]

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:  # noqa: FBT001
        return np.asarray(self[:], dtype)

    def __getitem__(self, key: Any) -> UInt8[np.ndarray, "..."]:
        """Read views.

        Raises
        ------
        ArenaError
            When they are no longer what was written.
        """
        keys = key if isinstance(key, tuple) else (key,)
        rows, *within = (slice(None), *keys) if keys[0] is Ellipsis else keys
        index = self._numbers[rows]
        chosen = index.ravel()
        images = np.empty((len(chosen), *self.shape[1:]), np.uint8)
        for shard in np.unique(chosen // SHARD):
            here = np.flatnonzero(chosen // SHARD == shard)
            images_here = [images[row] for row in here]
            self._read(shards(self._written[0])[shard], chosen[here] % SHARD, images_here)
        found = images.reshape(*index.shape, *self.shape[1:])
        return np.asarray(found[(slice(None),) * index.ndim + tuple(within)])

    def _read(self, shard: slice, chosen: np.ndarray, out: list[np.ndarray]) -> None:
        try:
            read_images(self._folder, shard, chosen, out)
        except DAMAGE as error:
            raise ArenaError(
                f"{file(self._folder, shard)} is damaged ({first_line(error)}); remove it, and the same "
                "command as before makes its views again, or open those that are whole with `arena.rescue`"
            ) from None


class Stored(NamedTuple):
    """What a folder holds."""

    views: StoredViews
    columns: dict[str, np.ndarray]
    """All other arrays by their names in the folder."""
    attributes: dict[str, Any]
    missing: list[slice]
    """Which views are not there or cannot be read, by shards."""


@contextmanager
def new_folder(
    path: Path, shape: tuple[int, ...], columns: Mapping[str, np.ndarray], attributes: Mapping[str, Any]
) -> Iterator[Path]:
    """Give a folder that lacks but the views of this shape; it takes the name `path` at the end.

    Whatever fails or is killed leaves none. `sharding.write_shards` puts the views into its folder `views`,
    now or later. Of the attributes, `version`, `arrays` and `digest` are the layout's own.

    Raises
    ------
    ArenaError
        When there is something at `path`, or the folder cannot be written.
    """
    with atomic_write(path, ArenaError, overwrite=False) as folder:
        describe(folder, shape, columns, attributes)
        yield folder


def describe(
    folder: Path, shape: tuple[int, ...], columns: Mapping[str, np.ndarray], attributes: Mapping[str, Any]
) -> None:
    """Write all of a recording but the images into a folder, which may hold these already."""
    group = zarr.create_group(folder, zarr_format=3, attributes={**plain(attributes), "version": VERSION})
    for name, values in columns.items():
        group.create_array(name, **_described(name, values.shape, str(values.dtype)))[...] = values
    group.create_array("views", **_described("views", shape, "uint8"))
    arrays = {name: {"values": checksum(values)} for name, values in columns.items()} | {"views": {}}
    for name, told in arrays.items():
        told["description"] = digest(_json(folder / name))
    group.attrs["arrays"] = arrays
    # of what JSON has made of them
    group.attrs["digest"] = digest(_json(folder))


class Head(NamedTuple):
    """What a recording says of itself."""

    attributes: dict[str, Any]
    arrays: dict[str, dict[str, str]]
    """Digests of each array's description and values, by name."""
    sound: bool
    """Whether all this is what was written."""


def read_head(path: Path) -> Head:
    """Read what a recording says of itself.

    Raises
    ------
    ArenaError
        When it is missing, not a recording or of another version.
    """
    if not path.exists():
        raise ArenaError(f"there is no recording at {path}; check the path or make one with `explore`")
    try:
        described = _json(path)
        attributes: dict[str, Any] = described["attributes"]
        version = attributes["version"]
    except DAMAGE:
        raise ArenaError(
            f"{path} is not a recording; give a folder that `explore` or `save` has written"
        ) from None
    if version != VERSION:
        raise ArenaError(
            f"{path} has the layout of version {version!r}, not {VERSION}; record it again, "
            "or open it with the program that wrote it"
        )
    written = attributes.pop("digest", None)
    sound = written == digest(described)
    del attributes["version"]
    arrays: Any = attributes.pop("arrays", None)
    return Head(attributes, arrays if isinstance(arrays, dict) else {}, sound)


def load(path: Path) -> Stored:
    """Open a recording that may still lack views.

    Raises
    ------
    ArenaError
        When it is missing, not a recording, of another version or damaged.
    """
    attributes, arrays, sound = read_head(path)
    try:
        if not sound:
            raise ValueError("its attributes are not what was written")
        columns = {name: read_column(path, name, told) for name, told in arrays.items() if name != "views"}
        views = find_views(path, arrays)
        missing = [rows for rows in shards(len(views)) if not is_complete(path / "views", rows)]
    except DAMAGE as error:
        raise ArenaError(
            f"{path} is damaged ({first_line(error)}); record it again, or open what is whole with "
            "`arena.rescue`"
        ) from None
    return Stored(views, columns, attributes, missing)


def read_column(path: Path, name: str, told: Mapping[str, str]) -> np.ndarray:
    """Read an array of a recording and compare it with its digests; raises any of `DAMAGE`."""
    _describe_again(path, name, told)
    try:
        values = np.asarray(zarr.open_array(path / name, mode="r", zarr_format=3)[...])
    except DAMAGE as error:
        raise ValueError(f"{name} cannot be read: {first_line(error)}") from None
    if checksum(values) != told["values"]:
        raise ValueError(f"{name} does not match its checksum")
    return values


def find_views(path: Path, arrays: Mapping[str, Mapping[str, str]]) -> StoredViews:
    """Find the views of a recording by their description, if this is sound; raises any of `DAMAGE`."""
    return StoredViews(path / "views", tuple(_describe_again(path, "views", arrays["views"])["shape"]))


def say_what_is_missing(path: Path, count: int, missing: list[slice], command: str) -> str:
    """Say in a sentence which views of a recording are not there or cannot be read, and what makes them."""
    present = count - sum(rows.stop - rows.start for rows in missing)
    broken = [file(path / "views", rows) for rows in missing if file(path / "views", rows).exists()]
    if broken:
        return (
            f"{path} is damaged: {present} of its {count} views are there, and {broken[0]} is not whole; the "
            f"same `{command}` command makes the others again, or open those that are whole with "
            "`arena.rescue`"
        )
    return (
        f"{path} is half-written: {present} of its {count} views are there; "
        f"the same `{command}` command goes on where it stopped"
    )


def first_line(error: Exception) -> str:
    """Give the first line of what an error says."""
    return (str(error).splitlines() or [type(error).__name__])[0]


def _described(name: str, shape: tuple[int, ...], dtype: str) -> dict[str, Any]:
    """Describe an array to zarr; all but the views are one chunk."""
    described: dict[str, Any] = {"shape": shape, "dtype": dtype}
    if name == "views":
        in_shards = {"chunks": (1, *shape[1:]), "shards": (SHARD, *shape[1:])}
        return {**described, **in_shards, "compressors": codecs()}
    return {**described, "chunks": tuple(max(1, size) for size in shape), "compressors": Crc32cCodec()}


def _json(folder: Path) -> dict[str, Any]:
    """Read what describes a group or an array."""
    described: dict[str, Any] = json.loads((folder / "zarr.json").read_bytes())
    return described


def _describe_again(path: Path, name: str, told: Mapping[str, str]) -> dict[str, Any]:
    """Read what describes an array; a flipped bit in its shape would fill the memory."""
    try:
        described = _json(path / name)
    except DAMAGE as error:
        raise ValueError(f"{name} cannot be read: {first_line(error)}") from None
    if digest(described) != told["description"]:
        raise ValueError(f"{name} is described otherwise than it was written")
    return described
