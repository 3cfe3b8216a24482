"""Rescue: what is whole of a recording that has suffered on disk, every image of it read and compared."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Bool

from arena.errors import ArenaError
from arena.paths import user_path
from arena.recordings import storage
from arena.recordings.recording import Recording, from_columns
from arena.recordings.sharding import file, is_complete, shards
from arena.recordings.storage import DAMAGE, StoredViews, first_line


@dataclass(frozen=True, eq=False)
class Examined:
    """What is whole of a recording on disk."""

    views: StoredViews | None
    """All of them, whole or not; None where not even their number and size is known."""
    whole: Bool[np.ndarray, " views"]
    """Which of them are."""
    columns: dict[str, np.ndarray]
    """All other arrays that are whole."""
    attributes: dict[str, Any]
    """Empty where they are not what was written."""
    unwritten: int
    """Views that are still to be made: of an exploration that was killed, no damage."""
    damage: tuple[str, ...]
    """What is not whole, each in a clause; empty when nothing is damaged."""


def examine(path: str | Path) -> Examined:
    """Compare all that a recording holds with its checksums, and tell what is whole.

    Raises
    ------
    ArenaError
        When it is missing, not a recording or of another version.
    """
    path = user_path(path)
    attributes, arrays, sound = storage.read_head(path)
    damage = [] if sound else ["its attributes are not what was written"]
    columns, views, whole = dict[str, np.ndarray](), None, np.zeros(0, bool)
    for name, told in arrays.items():
        try:
            if name == "views":
                views = storage.find_views(path, arrays)
            else:
                columns[name] = storage.read_column(path, name, told)
        except DAMAGE as error:
            damage.append(first_line(error))
    unwritten = 0
    if views is not None:
        whole = np.zeros(len(views), bool)
        for rows in shards(len(views)):
            shard = file(path / "views", rows)
            if not shard.exists():
                unwritten += rows.stop - rows.start
            elif is_complete(path / "views", rows):
                whole[rows] = _readable(views, rows)
            if shard.exists() and not whole[rows].all():
                lost = rows.start + np.flatnonzero(~whole[rows])
                damage.append(f"in {shard} {len(lost)} views cannot be read, the first is view {lost[0]}")
    return Examined(views, whole, columns, attributes if sound else {}, unwritten, tuple(damage))


def rescue(path: str | Path) -> Recording:
    """Open what is whole of a recording: views that cannot be read are left out, and arrays that cannot.

    Every image is read once. The views stay on disk; `save` writes them to a recording of their own. Its
    attributes are empty where they are not what was written, but for `rescued`: of how many views, and which
    of them are lost.

    Raises
    ------
    ArenaError
        When it is missing, not a recording or of another version, or nothing that makes a recording is whole.
    """
    found = examine(path)
    if found.views is None or "times" not in found.columns or not found.whole.any():
        raise ArenaError(
            f"nothing of {path} can be rescued: {'; '.join(found.damage) or 'no views are there yet'}; "
            "record it again"
        )
    numbers = np.flatnonzero(found.whole)
    columns = {name: values[numbers] for name, values in found.columns.items()}
    lost = {"of": len(found.whole), "lost": np.flatnonzero(~found.whole).tolist()}
    return from_columns(found.views.only(numbers), columns, {**found.attributes, "rescued": lost})


def _readable(views: StoredViews, rows: slice) -> Bool[np.ndarray, " shard"]:
    """Tell which views of a shard can be read."""

    def can_be_read(key: slice | int) -> bool:
        try:
            views[key]
        except ArenaError:
            return False
        return True

    if can_be_read(rows):
        return np.ones(rows.stop - rows.start, bool)
    return np.array([can_be_read(number) for number in range(rows.start, rows.stop)])
