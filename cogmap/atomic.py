"""Files and folders that appear under their name only when they are whole."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from cogmap.errors import CogmapError


@contextmanager
def whole(path: Path) -> Iterator[Path]:
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
