"""Where an experiment writes: a folder that appears only when it is whole."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cogmap.errors import CogmapError

METRICS = "metrics.json"
"""What every finished experiment leaves, and what marks a folder as one."""


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
