"""Atomic writes: results and maps that appear under their name only when they are whole."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

from cogmap.errors import CogmapError

METRICS = "metrics.json"
"""What every finished experiment leaves, and what marks a folder as one."""


def atomic_write(path: Path, *, overwrite: bool = True) -> AbstractContextManager[Path]:
    """Write as `arena.atomic.atomic_write` does, and raise a `CogmapError` when it cannot be done."""
    # Only when something is written: a map that grows in memory does without the arena and its compiler.
    from arena import atomic  # noqa: PLC0415

    return atomic.atomic_write(path, CogmapError, overwrite=overwrite)


def check_absent(path: Path) -> None:
    """Raise when there is something at a path already."""
    from arena import atomic  # noqa: PLC0415

    atomic.check_absent(path, CogmapError)


def check_replaceable(out: Path) -> None:
    """Raise unless `out` is free, empty, or the result of an earlier experiment, which may be replaced."""
    if not out.exists() and not out.is_symlink():
        return
    if not out.is_dir() or (any(out.iterdir()) and not (out / METRICS).is_file()):
        raise CogmapError(f"{out} exists and is not the result of an experiment; choose another folder")


@contextmanager
def result_folder(out: Path) -> Iterator[Path]:
    """Give a folder to fill, which takes the place of `out` at the end; a failure changes nothing.

    Raises
    ------
    CogmapError
        When `out` holds anything but an earlier result, or cannot be written.
    """
    check_replaceable(out)
    with atomic_write(out) as folder:
        folder.mkdir()
        yield folder
