"""The ledger of a sweep on disk: its plan, and one file for each point that is finished."""

import errno
import hashlib
import json
import shutil
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeGuard

from filelock import FileLock, Timeout

from arena.atomic import atomic_write
from cogmap.atomic import check_replaceable
from cogmap.digests import digest
from cogmap.errors import CogmapError
from cogmap.sweeps.plan import Plan
from cogmap.sweeps.points import Point, name_of

MARK = "sweep.json"
"""What marks a folder as that of a sweep."""

LAYOUT = 2
"""Version of the folder."""
FORMAT = f"cogmap sweep {LAYOUT}"

KEPT = "all points that are finished are kept, and the same command goes on from there"
"""What a sweep that ends early says."""

Record = dict[str, Any]


@dataclass(frozen=True)
class Ledger:
    """The folder of a sweep, seen by all who work on it.

    A file in `points` is whole whenever it is there. In `work` are locks, which may be lost. In `walks` are
    recordings that points share.
    """

    folder: Path

    @property
    def walks(self) -> Path:
        """Where recordings are shared."""
        return self.folder / "walks"

    @property
    def work(self) -> Path:
        """Where locks are."""
        return self.folder / "work"

    @contextmanager
    def opened(self, plan: Plan, points: Sequence[Point], *, keep_walks: bool = False) -> Iterator[None]:
        """Begin a sweep or go on with it, alone; at a good end, put away what is no longer needed.

        Raises
        ------
        CogmapError
            When the folder holds something else, someone else is at it, or it cannot be written.
        """
        check_replaceable(self.folder, MARK, "the folder of a sweep; choose another", (self.work.name,))
        with disk_errors(self.folder):
            self.work.mkdir(parents=True, exist_ok=True)
        try:
            lock = FileLock(self.work / "sweep.lock").acquire(timeout=0)
        except Timeout:
            raise CogmapError(
                f"another command is at the sweep in {self.folder}; wait for its end or choose another"
            ) from None
        with lock:
            self._lay_out(plan, points)
            yield
            shutil.rmtree(self.work, ignore_errors=True)
            if not keep_walks:
                shutil.rmtree(self.walks, ignore_errors=True)

    def read(self, point: Point) -> Record | None:
        """Give what is known of a point, None when it is not finished.

        Raises
        ------
        CogmapError
            For a file that is no longer what was written.
        """
        return read_record(self._path(point))

    def lacks(self, point: Point, *, again: bool) -> bool:
        """Whether a point is still to be done: it is not finished, or has failed and is to be done again."""
        record = self.read(point)
        return record is None or (again and "error" in record)

    def write(self, point: Point, record: Record) -> None:
        """Put down what was found, or that it failed."""
        with self.replacing(self._path(point)) as fresh:
            fresh.write_text(sealed({"point": point.described, **record}), encoding="utf-8")

    def lock(self, point: Point) -> FileLock:
        """Make the lock of a point, which whoever works on it holds."""
        return FileLock(self.work / f"{point.digest}.lock")

    @contextmanager
    def replacing(self, path: Path) -> Iterator[Path]:
        """Give a path to write to, which takes the place of `path` once it is whole and on the disk."""
        with disk_errors(self.folder), atomic_write(path) as fresh:
            yield fresh

    def _path(self, point: Point) -> Path:
        return self.folder / "points" / f"{point.digest}.json"

    def _lay_out(self, plan: Plan, points: Sequence[Point]) -> None:
        mark = self.folder / MARK
        names = all_of(point.digest for point in points)
        if mark.exists():
            found = read_mark(mark)
            if found["points"] != names:
                raise CogmapError(
                    f"{self.folder} holds another sweep (of {found.get('experiment')!r}); "
                    "choose another folder or remove it first"
                )
        else:
            described = plan.model_dump(mode="json", by_alias=True, exclude_defaults=True)
            header = {"format": FORMAT, "points": names, **described}
            with self.replacing(mark) as fresh:
                fresh.write_text(sealed(header), encoding="utf-8")
        with disk_errors(self.folder):
            self.walks.mkdir(exist_ok=True)


def all_of(names: Iterable[str]) -> str:
    """Give one digest of the names of points, in whatever order."""
    return hashlib.sha256("".join(sorted(names)).encode()).hexdigest()


def sealed(record: Record) -> str:
    """Give a record as JSON, with its digest."""
    return json.dumps({**record, "digest": digest(record)}, indent=1) + "\n"


def read_mark(path: Path) -> Record:
    """Read what marks a folder as that of a sweep.

    Raises
    ------
    CogmapError
        For a file that is no longer what was written, or of another layout.
    """
    found = _read(path)
    if isinstance(found, dict) and found.get("format") not in (FORMAT, None):
        raise CogmapError(
            f"{path.parent} is of the format {found['format']!r}, not {FORMAT!r}; choose another "
            "folder, or go on with the program that began it"
        )
    if not _is_sealed(found):
        raise CogmapError(f"{path} is damaged; choose another folder for the sweep")
    return found


def read_record(path: Path) -> Record | None:
    """Give what the file of a point says, None when there is none.

    Raises
    ------
    CogmapError
        For a file that is no longer what was written, or has the name of another point.
    """
    if not path.exists():
        return None
    record = _read(path)
    if not _is_sealed(record) or name_of(record["point"]) != path.stem:
        raise CogmapError(f"{path} is damaged; remove it and the same command does this point again")
    return record


def _read(path: Path) -> Any:
    """Read JSON, None where it is none."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None


def _is_sealed(record: Any) -> TypeGuard[Record]:
    """Whether what was read is what was written; takes its digest away."""
    return isinstance(record, dict) and record.pop("digest", None) == digest(record)


@contextmanager
def disk_errors(folder: Path) -> Iterator[None]:
    """Turn what goes wrong with the disk into a sentence."""
    try:
        yield
    except OSError as error:
        raise CogmapError(f"cannot write to {folder}: {error.strerror or error}; {KEPT}") from None


def is_full_disk(error: BaseException | None) -> bool:
    """Whether an error, or one that led to it, says that there is no space left to write."""
    while error is not None:
        if isinstance(error, OSError) and error.errno in {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}:
            return True
        error = error.__cause__ or error.__context__
    return False
