"""Kernels: loops that numba compiles, and the cache of what it has compiled.

numba's own cache looks at the file of the kernel that is called, not at those of the helpers and constants
that are compiled into it. Here a hash of all of them names the folder of the cache, so that an edit of any
leads to another one.
"""

import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

from numba import config, njit

# Its attributes are made when it is imported, which mypy does not see.
_settings: Any = config
Function = TypeVar("Function", bound=Callable[..., Any])


def cache_folder(root: Path, *parts: str) -> Path | None:
    """Find where to cache the kernels that are in parts of the package at `root`; None if nowhere.

    The first that can be written of `NUMBA_CACHE_DIR`, the package's `__pycache__` and the user's cache. A
    new folder takes the place of those that the same package had there before it was edited.
    """
    sources = [Path(__file__), root / "kernels.py"]
    for part in parts:
        sources += sorted((root / part).rglob("*.py"))
    edition = hashlib.sha256(b"".join(hashlib.sha256(file.read_bytes()).digest() for file in sources))
    # A user's installations share one cache and leave each other's kernels alone.
    package = f"kernels-{hashlib.sha256(os.fsencode(root)).hexdigest()[:8]}"
    user = Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache")
    for place in filter(None, (_settings.CACHE_DIR, root / "__pycache__", user / "cogmap")):
        try:
            folder = Path(place).expanduser().absolute() / f"{package}-{edition.hexdigest()[:16]}"
            if not folder.exists():
                folder.mkdir(parents=True, exist_ok=True)
                for old in set(folder.parent.glob(f"{package}-*")) - {folder}:
                    shutil.rmtree(old, ignore_errors=True)
            # Permissions do not tell: the file system itself may be read-only.
            tempfile.TemporaryFile(dir=folder).close()
        except (OSError, RuntimeError):  # the second for a user without a home
            continue
        return folder
    return None


def kernels_cached_in(folder: Path | None) -> Callable[..., Callable[[Function], Function]]:
    """Make the decorator of the kernels that are cached in a folder."""

    def kernel(**options: Any) -> Callable[[Function], Function]:
        """Compile a function by numba's `njit` with these options; it divides as numpy does, by zero as well.

        An option that is not given is the caller's: what an inlined kernel calls is inlined, too.
        """

        def compiled(function: Function) -> Function:
            # numba asks for the folder now and never again, and other packages keep theirs.
            before, _settings.CACHE_DIR = _settings.CACHE_DIR, str(folder)
            try:
                made = njit(cache=folder is not None, error_model="numpy", **options)
                return cast("Function", made(function))
            finally:
                _settings.CACHE_DIR = before

        return compiled

    return kernel


_folder = cache_folder(Path(__file__).parent, "bodies", "eye", "smell", "rooms")
kernel = kernels_cached_in(_folder)


def bare_kernel(**options: Any) -> Callable[[Function], Function]:
    """Compile a kernel that makes no arrays, as by `kernel`.

    numba then does not count who holds which array: an atomic instruction each time that one is taken out of
    a tuple or given a name, which takes as long as painting several pixels.
    """
    return kernel(_nrt=False, **options)
