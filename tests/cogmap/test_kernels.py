import importlib
import pkgutil
from pathlib import Path

from numba.core.dispatcher import Dispatcher

import cogmap
from arena.kernels import cache_folder

PACKAGE = Path(cogmap.__file__).parent
FOLDERS = ("graph", "imagination")


def test_every_kernel_is_in_the_folder_and_its_source_in_the_hash() -> None:
    names = [
        f"cogmap.{folder}.{module.name}"
        for folder in FOLDERS
        for module in pkgutil.iter_modules([str(PACKAGE / folder)])
    ]
    found = [
        value
        for name in names
        for value in vars(importlib.import_module(name)).values()
        if isinstance(value, Dispatcher)
    ]
    assert len(found) >= 4
    assert {Path(one.py_func.__code__.co_filename).parent.name for one in found} == set(FOLDERS)
    folder = cache_folder(PACKAGE, *FOLDERS)
    assert folder != cache_folder(PACKAGE)
    assert all(str(folder) in str(one.stats.cache_path) for one in found)
