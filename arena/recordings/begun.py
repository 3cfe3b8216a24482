"""Imports that have begun: how far they are, in the folder that is to be a recording."""

import json
from pathlib import Path
from typing import Any, NamedTuple

from arena.atomic import atomic_write
from arena.errors import ArenaError
from arena.recordings import storage
from arena.recordings.resuming import refuse_another
from arena.recordings.sharding import SHARD

BEGUN = "begun.json"
"""File in a folder that is not a recording yet: what is being imported, and how far it is."""


def unfinished(path: Path) -> int | None:
    """Tell how many views an import has left that was killed; None where there is no such.

    Raises
    ------
    ArenaError
        When it is damaged.
    """
    if not (path / BEGUN).is_file():
        return None
    return Begun.read(path).views


class Begun(NamedTuple):
    """How far an import is."""

    shards: list[int]
    """A checksum of what each shard was made from; it grows while one goes on."""
    views: int
    whole: storage.Stored | None = None
    """The recording, if it is one already."""

    @classmethod
    def at(cls, path: Path, wanted: dict[str, Any]) -> "Begun":
        """Begin, or find what was begun, which must be of this."""
        if not path.exists():
            with atomic_write(path, ArenaError, overwrite=False) as folder:
                folder.mkdir()
                note(folder, wanted, [], 0)
            return cls([], 0)
        if (path / BEGUN).is_file():
            return cls.read(path, wanted)
        stored = storage.load(path)
        refuse_another(path, stored.attributes, wanted)
        return cls(list(stored.attributes["shards"]), len(stored.views), stored)

    @classmethod
    def read(cls, path: Path, wanted: dict[str, Any] | None = None) -> "Begun":
        """Read how far it is."""
        try:
            told = json.loads((path / BEGUN).read_text(encoding="utf-8"))
            begun = cls([int(shard) for shard in told["shards"]], int(told["views"]))
            sound = len(begun.shards) == -(-begun.views // SHARD)
        except (OSError, ValueError, LookupError, TypeError):
            sound = False
        if not sound:
            raise ArenaError(f"{path / BEGUN} is damaged; remove {path} and import again")
        refuse_another(path, told, wanted or {})
        return begun


def note(path: Path, wanted: dict[str, Any], shards: list[int], views: int) -> None:
    """Write down how far an import is."""
    with atomic_write(path / BEGUN) as fresh:
        fresh.write_text(json.dumps({**wanted, "shards": shards, "views": views}), encoding="utf-8")
