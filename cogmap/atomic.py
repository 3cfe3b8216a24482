"""Atomic writes: files and folders that appear under their name only when they are whole."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from cogmap.errors import CogmapError

METRICS = "metrics.json"
"""What every finished experiment leaves, and what marks a folder as one."""


@contextmanager
def atomic_write(path: Path) -> Iterator[Path]:
    """Give another path, for a file or a folder that takes the name of `path` at the end.

    A file that is there already is replaced, a failure changes nothing.

    Raises
    ------
    CogmapError
        When it cannot be written.
    """
    partial = path.with_name(f".{path.stem}.{os.getpid()}.partial{path.suffix}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield partial
        partial.replace(path)
    except OSError as error:
        raise CogmapError(f"cannot write {path}: {error.strerror or error}") from None
    finally:
        shutil.rmtree(partial, ignore_errors=True)
        with suppress(OSError):
            partial.unlink()


def check_absent(path: Path) -> None:
    """Raise when there is something at a path already."""
    if path.exists() or path.is_symlink():
        raise CogmapError(
            f"{path} exists already and is left as it is; choose another path or remove it first"
        )


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
    folder = out.with_name(f".{out.name}.{os.getpid()}.partial")
    old = out.with_name(f".{out.name}.{os.getpid()}.old")
    try:
        folder.mkdir(parents=True)
        yield folder
        if out.exists():
            out.rename(old)
        folder.rename(out)
    except OSError as error:
        raise CogmapError(f"cannot write {out}: {error.strerror or error}") from None
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        shutil.rmtree(old, ignore_errors=True)
