"""Kernels: loops that numba compiles, and the cache of what it has compiled.

numba's own cache looks at the file of the kernel that is called, not at those of the helpers and constants that
are compiled into it. Here the folder of the cache bears a hash of all of them: an edit of any leads elsewhere.
"""

import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from numba import config, njit

_F = TypeVar("_F", bound=Callable[..., Any])


def cache_folder(root: Path = Path(__file__).parent) -> Path | None:
    """Find where to cache the kernels of the package at `root`; None where nothing can be written.

    The first that can be written of numba's `NUMBA_CACHE_DIR`, the package's `__pycache__` and the user's
    cache. A new folder takes the place of what the same package had cached there before it was edited.
    """
    sources = [root / "kernels.py"]
    for part in ("eye", "smell", "rooms"):
        sources += sorted((root / part).rglob("*.py"))
    edition = hashlib.sha256(b"".join(hashlib.sha256(file.read_bytes()).digest() for file in sources))
    # The user's cache serves several installations, which must leave each other's kernels alone.
    package = f"kernels-{hashlib.sha256(os.fsencode(root)).hexdigest()[:8]}"
    user = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    for place in (config.CACHE_DIR, root / "__pycache__", os.path.join(user, "cogmap")):
        # Empty when not set, and "~" stays as it is for a user without a home.
        if not os.path.isabs(place):
            continue
        folder = Path(place) / f"{package}-{edition.hexdigest()[:16]}"
        try:
            if not folder.exists():
                folder.mkdir(parents=True, exist_ok=True)
                for old in set(folder.parent.glob(f"{package}-*")) - {folder}:
                    shutil.rmtree(old, ignore_errors=True)
            # Permissions alone do not tell: the file system may be read-only.
            tempfile.TemporaryFile(dir=folder).close()
        except OSError:
            continue
        return folder
    return None


_folder = cache_folder()


def kernel(**options: bool) -> Callable[[_F], _F]:
    """Compile a function by numba's `njit` with these options, dividing as numpy does: x / 0 is inf or NaN."""

    def compiled(function: _F) -> _F:
        # numba asks for the folder here, once; other packages' kernels have theirs.
        before, config.CACHE_DIR = config.CACHE_DIR, str(_folder or "")
        try:
            made: _F = njit(function, cache=_folder is not None, error_model="numpy", **options)
        finally:
            config.CACHE_DIR = before
        return made

    return compiled
