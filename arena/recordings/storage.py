"""Storage of a recording on disk: a zarr 3 group of named arrays with checksums, the views in shards."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import zarr
from jaxtyping import UInt8
from zarr.codecs import Crc32cCodec

from arena.atomic import atomic_write
from arena.errors import ArenaError
from arena.recordings.sharding import SHARD, codecs, file, is_complete, read_images, shards

VERSION = 3
"""Of the layout."""

# What zarr has been seen to raise on damaged metadata and chunks.
_DAMAGE = (OSError, ValueError, LookupError, TypeError, AttributeError, RuntimeError, ArithmeticError)


class StoredViews:
    """Views on disk, indexed like a numpy array: what is asked for is read and compared with its checksum."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        array = _opened(folder)
        self.shape: tuple[int, ...] = array.shape
        self.dtype = array.dtype
        self.ndim = len(self.shape)

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
        index = np.arange(len(self))[rows]
        chosen = index.ravel()
        images = np.empty((len(chosen), *self.shape[1:]), np.uint8)
        for shard in np.unique(chosen // SHARD):
            here = np.flatnonzero(chosen // SHARD == shard)
            self._read(shards(len(self))[shard], chosen[here] % SHARD, [images[row] for row in here])
        found = images.reshape(*index.shape, *self.shape[1:])
        return np.asarray(found[(slice(None),) * index.ndim + tuple(within)])

    def _read(self, shard: slice, chosen: np.ndarray, out: list[np.ndarray]) -> None:
        try:
            read_images(self._folder, shard, chosen, out)
        except _DAMAGE as error:
            raise ArenaError(
                f"{file(self._folder, shard)} is damaged ({_first_line(error)}); remove it, and the same "
                "`explore` command makes its views again"
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
    now or later. Of the attributes, `version` and `arrays` are the layout's own.

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
    own = {"version": VERSION, "arrays": list(columns)}
    group = zarr.create_group(folder, zarr_format=3, attributes={**attributes, **own})
    # By default zeros would not be written at all, and could not be told from a file that was lost.
    with zarr.config.set({"array.write_empty_chunks": True}):
        for name, values in columns.items():
            group.create_array(name, **_described(name, values.shape, str(values.dtype)))[...] = values
    group.create_array("views", **_described("views", shape, "uint8"))


def load(path: Path) -> Stored:
    """Open a recording that may still lack views.

    Raises
    ------
    ArenaError
        When it is missing, not a recording, of another version or damaged.
    """
    if not path.exists():
        raise ArenaError(f"there is no recording at {path}; check the path or make one with `explore`")
    try:
        attributes: dict[str, Any] = zarr.open_group(path, mode="r", zarr_format=3).attrs.asdict()
        version = attributes.pop("version")
    except _DAMAGE:
        raise ArenaError(
            f"{path} is not a recording; give a folder that `explore` or `save` has written"
        ) from None
    if version != VERSION:
        raise ArenaError(
            f"{path} has the layout of version {version!r}, not {VERSION}; record it again, "
            "or open it with the program that wrote it"
        )
    try:
        # One by one: of what a group says of its arrays, zarr prints what it cannot read.
        columns = {name: _whole(path / name) for name in attributes.pop("arrays")}
        views = StoredViews(path / "views")
        missing = [rows for rows in shards(len(views)) if not is_complete(path / "views", rows)]
    except _DAMAGE as error:
        raise ArenaError(f"{path} is damaged ({_first_line(error)}); record it again") from None
    return Stored(views, columns, attributes, missing)


def _described(name: str, shape: tuple[int, ...], dtype: str) -> dict[str, Any]:
    """Describe an array to zarr; all but the views are one chunk."""
    described: dict[str, Any] = {"shape": shape, "dtype": dtype}
    if name == "views":
        in_shards = {"chunks": (1, *shape[1:]), "shards": (SHARD, *shape[1:])}
        return {**described, **in_shards, "compressors": codecs()}
    return {**described, "chunks": tuple(max(1, size) for size in shape), "compressors": Crc32cCodec()}


def _opened(path: Path) -> zarr.Array[Any]:
    """Open an array that is described as this program describes it: a bit of that may have flipped, too."""
    array = zarr.open_array(path, mode="r", zarr_format=3)
    described = _described(path.name, array.shape, str(array.dtype))
    if array.metadata != zarr.create_array({}, **described).metadata:
        raise ValueError(f"{path.name} is described otherwise")
    return array


def _whole(path: Path) -> np.ndarray:
    column = _opened(path)
    if column.nchunks_initialized < column.nchunks:
        raise ValueError(f"a part of {path.name} is missing")
    return np.asarray(column[...])


def _first_line(error: Exception) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]
