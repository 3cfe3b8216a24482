import importlib
import os
import pkgutil
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numba import config
from numba.core.dispatcher import Dispatcher

import arena
from arena import kernels
from arena.eye.camera import Camera
from arena.kernels import kernels_cached_in
from arena.rooms.arena import Arena

PACKAGE = Path(arena.__file__).parent
SOURCES = ["kernels.py", "bodies/bodies.py", "eye/eye.py", "smell/smell.py", "rooms/deeper/rooms.py"]


def folder_of(package: Path) -> Path | None:
    return kernels.cache_folder(package, "bodies", "eye", "smell", "rooms")


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package of four files, for a user whose cache is beside it."""
    monkeypatch.setattr(config, "CACHE_DIR", "")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "user"))
    for name in SOURCES:
        file = tmp_path / "package" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(name)
    return tmp_path / "package"


def bar(folder: Path) -> None:
    """Let nobody write here, not even the superuser: it is no folder."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    folder.touch()


def test_the_cache_is_beside_the_package_and_stays_there(package: Path) -> None:
    folder = folder_of(package)
    assert folder is not None
    assert folder.is_dir()
    assert folder.parent == package / "__pycache__"
    assert folder_of(package) == folder
    assert not list(folder.iterdir())


@pytest.mark.parametrize("name", SOURCES)
def test_an_edit_leads_to_another_folder_in_place_of_the_first(package: Path, name: str) -> None:
    before = folder_of(package)
    assert before is not None
    (before / "kernel.nbc").touch()
    (stranger := before.with_name("kernels-0-0")).mkdir()
    (package / name).write_text("edited")
    after = folder_of(package)
    assert after is not None
    assert set(before.parent.iterdir()) == {after, stranger}
    assert after != before


def test_the_user_chooses_first_and_has_a_cache_of_their_own(
    package: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bar(package / "__pycache__")
    folder = folder_of(package)
    assert folder is not None
    assert folder.parent == tmp_path / "user" / "cogmap"
    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path / "chosen"))
    folder = folder_of(package)
    assert folder is not None
    assert folder.parent == tmp_path / "chosen"


def test_two_installations_keep_their_kernels_apart(package: Path) -> None:
    other = package.with_name("other")
    shutil.copytree(package, other)
    (other / "eye" / "eye.py").write_text("of another version")
    for root in (package, other):
        bar(root / "__pycache__")
    first = folder_of(package)
    assert first is not None
    assert folder_of(other) not in (None, first)
    assert first.is_dir()


@pytest.mark.parametrize("homeless", [False, True])
def test_no_cache_where_nothing_can_be_written(
    package: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, homeless: bool
) -> None:
    bar(package / "__pycache__")
    bar(tmp_path / "user")
    if homeless:
        monkeypatch.delenv("XDG_CACHE_HOME")
        monkeypatch.setattr(os.path, "expanduser", lambda path: path)
    monkeypatch.chdir(tmp_path)
    assert folder_of(package) is None
    assert {path.name for path in tmp_path.iterdir()} == {"package", "user"}


def test_every_kernel_is_in_the_folder_and_its_source_in_the_hash() -> None:
    names = [module.name for module in pkgutil.walk_packages(arena.__path__, "arena.")]
    found = {
        value
        for name in names
        for value in vars(importlib.import_module(name)).values()
        if isinstance(value, Dispatcher)
    }
    assert len(found) > 25
    hashed = {file for part in ("bodies", "eye", "smell", "rooms") for file in (PACKAGE / part).rglob("*.py")}
    assert {Path(one.py_func.__code__.co_filename) for one in found} <= hashed
    assert all(str(kernels._folder) in str(one.stats.cache_path) for one in found)


def test_a_kernel_divides_by_zero_and_leaves_the_setting_of_others(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(config, "CACHE_DIR", "of others")

    @kernels_cached_in(None)()
    def half(x: float) -> float:
        return 1.0 / x

    assert half(0.0) == np.inf
    assert half.stats.cache_path is None  # type: ignore[attr-defined]
    assert config.CACHE_DIR == "of others"


HELPER = """
from small.kernels import kernel

@kernel(inline="always")
def shared(x):
    return 3 * x
"""
CALLER = """
from small.eye.helper import shared
from small.kernels import kernel

@kernel()
def looked_at(x):
    return shared(x)
"""
SMALL = "from small.eye.caller import looked_at; print(looked_at(7)); from small.kernels import _folder"
ARENA = """
import sys
import numpy as np
from arena import Arena, Camera, Nose
from arena.kernels import _folder
room, pose = Arena.load("furnished"), np.array([(0.3, -0.2, 1.0)])
sys.stdout.buffer.write(Camera.panoramic(36, 12).render(room, pose).tobytes())
Nose().smell(room.odours.concentration(pose[:, :2]), np.zeros(1), np.random.default_rng(0))
"""


def small(folder: Path) -> Path:
    """Make a package of two kernels, one inlined into that of another file, with the arena's `kernels`."""
    package = folder / "small"
    for name in ("eye", "smell", "rooms"):
        (package / name).mkdir(parents=True)
    (package / "eye" / "helper.py").write_text(HELPER, encoding="utf-8")
    (package / "eye" / "caller.py").write_text(CALLER, encoding="utf-8")
    shutil.copy(PACKAGE / "kernels.py", package)
    return package


def arena_itself(folder: Path) -> Path:
    shutil.copytree(PACKAGE, folder / "arena", ignore=shutil.ignore_patterns("__pycache__"))
    return folder / "arena"


class Looked(NamedTuple):
    """A package, a look at it, a kernel, and a file of helpers with an edit of it."""

    make: Callable[[Path], Path]
    look: str
    kernel: str
    helper: str
    edit: tuple[str, str]


BLEND = "np.uint16(share * second)", "np.uint16(0.5 * share * second)"


@pytest.mark.parametrize(
    "looked",
    [
        # Of another length: one of the same within a second is not seen by Python's own bytecode.
        Looked(small, SMALL, "caller.looked_at", "helper.py", ("3 * x", "40 * x")),
        # Compiled three times over, which takes most of a minute.
        pytest.param(
            Looked(arena_itself, ARENA, "render.render", "texture_sampling.py", BLEND),
            marks=pytest.mark.full,
        ),
    ],
    ids=["small", "arena"],
)
def test_an_edit_shows_at_once_and_nothing_need_be_writable(looked: Looked, tmp_path: Path) -> None:
    copy = looked.make(tmp_path)
    edited = copy / "eye" / looked.helper
    source = edited.read_text(encoding="utf-8")
    settings = {
        key: os.environ[key] for key in os.environ if key not in ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME")
    }
    # Optimised a little, which takes less time; what is not optimised at all numba does not cache.
    settings |= {"PYTHONPATH": str(tmp_path), "HOME": "/dev/null", "NUMBA_OPT": "1"}

    def look() -> tuple[bytes, str]:
        script = f"{looked.look}\nimport sys; print(_folder, end='', file=sys.stderr)"
        run = subprocess.run(
            [sys.executable, "-c", script], cwd=tmp_path, env=settings, capture_output=True, check=False
        )
        assert run.returncode == 0, run.stderr.decode()
        return run.stdout, run.stderr.decode()

    before, folder = look()
    assert list(Path(folder).rglob(f"{looked.kernel}-*.nbc"))
    if looked.make is arena_itself:
        view = Camera.panoramic(36, 12).render(Arena.load("furnished"), np.array([(0.3, -0.2, 1.0)]))
        assert before == view.tobytes()
    assert list((copy / "__pycache__").glob("kernels-*")) == [Path(folder)]
    # Inlined into kernels of another file, which stays as it is.
    assert looked.edit[0] in source
    edited.write_text(source.replace(*looked.edit), encoding="utf-8")
    after, _ = look()
    assert after != before
    edited.write_text(source, encoding="utf-8")
    shutil.rmtree(copy / "__pycache__")
    (copy / "__pycache__").touch()
    for path in (copy, *copy.rglob("*")):
        path.chmod(path.stat().st_mode & ~0o222)
    assert look() == (before, "None")
