"""Storage of a recording on disk: a zarr 3 group, the views in shards."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import zarr
from jaxtyping import Int, UInt8

from arena.atomic import atomic_write
from arena.errors import ArenaError
from arena.recordings.sharding import SHARD, Writer, codec, file, is_complete, shard_writer, shards

VERSION = 2
"""Of the layout."""

_COLUMNS = ("odours", "times", "poses")
# What zarr has been seen to raise on damaged metadata and chunks.
_DAMAGE = (OSError, ValueError, LookupError, TypeError, AttributeError, RuntimeError, ArithmeticError)


class Stored(NamedTuple):
    """What a folder holds."""

    views: zarr.Array[Any]
    columns: dict[str, np.ndarray]
    """`odours`, `times` and, unless they were taken away, `poses`."""
    attributes: dict[str, Any]
    missing: list[slice]
    """Which views are not there or cannot be read, by shards."""


@contextmanager
def new_folder(path: Path) -> Iterator[Path]:
    """Give a folder to fill, which takes the name `path` at the end; whatever fails or is killed leaves none.

    Raises
    ------
    ArenaError
        When there is something at `path`, or the folder cannot be written.
    """
    with atomic_write(path, ArenaError, overwrite=False) as folder:
        folder.mkdir()
        yield folder


def lay_out(
    folder: Path, shape: tuple[int, ...], columns: Mapping[str, np.ndarray], attributes: Mapping[str, Any]
) -> None:
    """Write everything but the views."""
    group = zarr.create_group(folder, zarr_format=3, attributes={**attributes, "version": VERSION})
    # By default zeros would not be written at all, and could not be told from a file that was lost.
    with zarr.config.set({"array.write_empty_chunks": True}):
        for name, values in columns.items():
            group.create_array(name, data=values)
    group.create_array("views", **_views(shape))


@contextmanager
def writable_views(path: Path) -> Iterator[Writer]:
    """Write shards of views; see `sharding.shard_writer`."""
    with shard_writer(path / "views") as writer:
        yield writer


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
        attributes = zarr.open_group(path, mode="r", zarr_format=3).attrs.asdict()
        version = attributes["version"]
    except _DAMAGE:
        raise ArenaError(
            f"{path} is not a recording; give a folder that `explore` or `save` has written"
        ) from None
    if version != VERSION:
        raise ArenaError(
            f"{path} has the layout of version {version!r}, not {VERSION}; record it again with this program"
        )
    try:
        # One by one: of what a group says of its arrays, zarr prints what it cannot read.
        columns = {
            name: _whole(path / name) for name in _COLUMNS if name != "poses" or (path / name).exists()
        }
        views = zarr.open_array(path / "views", mode="r", zarr_format=3)
        if views.metadata != zarr.create_array({}, **_views(views.shape)).metadata:
            raise ValueError("the views are laid out otherwise")
        missing = [
            rows
            for rows in shards(views.shape[0])
            if not is_complete(file(path / "views", rows), rows.stop - rows.start)
        ]
    except _DAMAGE as error:
        raise ArenaError(f"{path} is damaged ({_first_line(error)}); record it again") from None
    return Stored(views, columns, attributes, missing)


def read(
    views: zarr.Array[Any], chosen: Int[np.ndarray, " chosen"]
) -> UInt8[np.ndarray, "chosen height width 3"]:
    """Read views by index, one slice a shard: zarr's own indexing by arrays takes 10 ms a view."""
    out = np.empty((len(chosen), *views.shape[1:]), np.uint8)
    shard = chosen // SHARD
    for item in np.unique(shard):
        here = np.flatnonzero(shard == item)
        low, high = chosen[here].min(), chosen[here].max()
        out[here] = np.asarray(views[low : high + 1])[chosen[here] - low]
    return out


def _views(shape: tuple[int, ...]) -> dict[str, Any]:
    """Describe the array of views to zarr."""
    return {
        "shape": shape,
        "dtype": "uint8",
        "chunks": (1, *shape[1:]),
        "shards": (SHARD, *shape[1:]),
        "compressors": codec(),
    }


def _whole(path: Path) -> np.ndarray:
    column = zarr.open_array(path, mode="r", zarr_format=3)
    if column.nchunks_initialized < column.nchunks:
        raise ValueError(f"a part of {path.name} is missing")
    return np.asarray(column[:])


def _first_line(error: Exception) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]
