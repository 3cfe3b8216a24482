"""The checkpoint: what a map that grows needs to go on after a kill, beside where it is to be."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from filelock import FileLock, Timeout

from cogmap.atomic import atomic_write
from cogmap.digests import digest
from cogmap.errors import CogmapError
from cogmap.map.cognitive_map import CognitiveMap

FORMAT = "cogmap growing 1"
KEPT = "what it has learnt is kept, and the same command goes on from there"
"""What a map that stops growing early says."""
_PLAN, _NOW, _PLACE = "growing.json", "now", "place.json"


class Place(NamedTuple):
    """How far a map has come."""

    stage: str
    """In which stage it learns."""
    merged: int
    """Of how many shares it has the sums of this stage."""


@dataclass(frozen=True)
class Checkpoint:
    """A folder beside that of the map, for as long as it grows.

    In it are what is to grow (`growing.json`), the map so far (`now`), and the map as those need it who
    learn shares of the present stage. All of them are whole whenever they are there.
    """

    folder: Path

    @classmethod
    def beside(cls, out: Path) -> Checkpoint:
        """Give that of a map that is to be at a path."""
        return cls(out.with_name(f"{out.name}.growing"))

    @contextmanager
    def opened(self, described: Mapping[str, Any]) -> Iterator[None]:
        """Begin to grow, or go on, alone; at a good end, put all of it away.

        Raises
        ------
        CogmapError
            When another map grows there, someone else is at it, or it cannot be written.
        """
        plan = self.folder / _PLAN
        if self.folder.exists() and not (self.folder.is_dir() and self._is_ours()):
            raise CogmapError(f"{self.folder} is in the way; choose another map or remove it first")
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            lock = FileLock(self.folder / "lock").acquire(timeout=0)
        except Timeout:
            raise CogmapError(
                f"another command grows a map in {self.folder}; wait for its end or choose another map"
            ) from None
        except OSError as error:
            raise CogmapError(f"cannot write to {self.folder}: {error.strerror or error}") from None
        with lock:
            wanted = {"format": FORMAT, **described}
            if plan.exists():
                self._refuse_another(wanted)
            else:
                with atomic_write(plan) as fresh:
                    fresh.write_text(json.dumps({**wanted, "digest": digest(wanted)}, indent=1), "utf-8")
            yield
            # the plan last: without it nobody could tell whose the rest is
            for item in self.folder.iterdir():
                if item.is_dir():
                    shutil.rmtree(item, ignore_errors=True)
            shutil.rmtree(self.folder, ignore_errors=True)

    def save(self, cmap: CognitiveMap, place: Place) -> None:
        """Put down the map so far, and how far it has come."""
        with atomic_write(self.folder / _NOW) as fresh:
            fresh.mkdir()
            cmap.save(fresh / "map")
            (fresh / _PLACE).write_text(json.dumps(place._asdict()), encoding="utf-8")

    def load(self) -> tuple[CognitiveMap, Place] | None:
        """Give what was put down last; None where nothing was.

        Raises
        ------
        CogmapError
            When it is damaged.
        """
        now = self.folder / _NOW
        if not now.exists():
            return None
        try:
            place = Place(**json.loads((now / _PLACE).read_text(encoding="utf-8")))
        except (OSError, ValueError, TypeError):
            raise CogmapError(f"{now} is damaged; remove {self.folder} and start again") from None
        return CognitiveMap.load(now / "map"), place

    @contextmanager
    def lent(self, name: str, make: Callable[[], CognitiveMap]) -> Iterator[Path]:
        """Put a map down for those who help, as long as they do; what lies there from before is the same."""
        # whoever helps keeps what it has read by its path
        path = self.folder / f"lent-{digest([self._plan(), name])[:16]}"
        if not path.exists():
            make().save(path)
        yield path
        # under another name, as it would not be whole on the way
        gone = self.folder / "gone"
        shutil.rmtree(gone, ignore_errors=True)
        path.rename(gone)
        shutil.rmtree(gone, ignore_errors=True)

    def _plan(self) -> str:
        return (self.folder / _PLAN).read_text(encoding="utf-8")

    def _is_ours(self) -> bool:
        return (self.folder / _PLAN).is_file() or {item.name for item in self.folder.iterdir()} <= {"lock"}

    def _refuse_another(self, wanted: dict[str, Any]) -> None:
        try:
            found = json.loads(self._plan())
            sealed = found.pop("digest", None) == digest(found)
        except (OSError, ValueError, AttributeError, TypeError):
            sealed = False
        if not sealed:
            raise CogmapError(f"{self.folder / _PLAN} is damaged; remove {self.folder} and start again")
        differing = [name for name in wanted if found.get(name) != wanted[name]]
        if differing:
            raise CogmapError(
                f"{self.folder} holds another map that grows, of a different {' and '.join(differing)}; "
                "choose another path, or remove it first"
            )
