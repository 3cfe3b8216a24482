import errno
import os
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from arena import atomic
from arena.atomic import atomic_write, check_absent, recover
from arena.errors import ArenaError

# Every line of the writer and of `shutil.rmtree` is a moment to be killed at; the kernel calls lie between.
KILLED = """
import importlib.util, os, shutil, signal, sys
from pathlib import Path

spec = importlib.util.spec_from_file_location("atomic", sys.argv[1])
atomic = importlib.util.module_from_spec(spec)
spec.loader.exec_module(atomic)
home, kind, kernel = Path(sys.argv[2]), sys.argv[3], sys.argv[4]
path = home / "result.x"
os.fsync = lambda _: None  # slow, and a kill cuts no power
if kernel == "old":
    class Library:
        def renameat2(self, *_):
            ctypes.set_errno(errno.ENOSYS)
            return -1
    import ctypes, errno
    atomic.ctypes.CDLL = lambda *_, **__: Library()

def write(text):
    with atomic.atomic_write(path) as fresh:
        if kind == "folder":
            fresh.mkdir()
        for name in ("a", "b"):
            (fresh / name if kind == "folder" else fresh).write_text(text)

def read():
    if kind == "folder":
        assert sorted(item.name for item in path.iterdir()) == ["a", "b"]
    (text,) = {item.read_text() for item in (path.iterdir() if kind == "folder" else [path])}
    return text

def killed_at(moment):
    child = os.fork()
    if child == 0:
        count = 0
        def trace(frame, event, arg):
            nonlocal count
            if frame.f_code.co_filename not in (sys.argv[1], shutil.__file__):
                return None
            count += event == "line"
            if count == moment:
                os.kill(os.getpid(), signal.SIGKILL)
            return trace
        sys.settrace(trace)
        write("new")
        os._exit(0)
    return os.waitpid(child, 0)[1] == signal.SIGKILL

write("old")
moment, found = 1, []
while killed_at(moment):
    if kernel == "old":
        atomic.recover(path)
    found.append(read())
    write("old")
    assert [item.name for item in home.iterdir()] == [path.name], (moment, list(home.iterdir()))
    moment += 1
assert read() == "new"
assert found == sorted(found, reverse=True)  # old up to one moment, new from there
print(found.count("old"), found.count("new"))
"""


def sibling(path: Path, process: int, kind: str = "partial") -> Path:
    return path.with_name(f".{path.stem}.{socket.gethostname()}-{process}-0123abcd.{kind}{path.suffix}")


@pytest.fixture
def dead() -> int:
    with subprocess.Popen([sys.executable, "-c", ""]) as process:
        process.wait()
    return process.pid


@pytest.mark.parametrize(("kind", "kernel"), [("file", "new"), ("folder", "new"), ("folder", "old")])
def test_killed_at_any_moment_there_is_what_was_or_what_is_new(
    tmp_path: Path, kind: str, kernel: str
) -> None:
    command = [sys.executable, "-c", KILLED, atomic.__file__, str(tmp_path), kind, kernel]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    before, after = map(int, done.stdout.split())
    assert before > 20
    assert after > 2


def test_it_appears_only_when_it_is_whole(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "page.html"
    with atomic_write(path) as fresh:
        fresh.write_text("half", encoding="utf-8")
        assert not path.exists()
        assert (fresh.parent, fresh.suffix) == (path.parent, path.suffix)
    assert path.read_text(encoding="utf-8") == "half"
    assert list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize("kind", ["file", "folder"])
def test_it_is_on_the_disk_before_it_has_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    path, synced, real = tmp_path / "x", [], os.fsync

    def fsync(descriptor: int) -> None:
        synced.append((Path(f"/proc/self/fd/{descriptor}").resolve(), path.exists()))
        real(descriptor)

    monkeypatch.setattr(os, "fsync", fsync)
    with atomic_write(path) as fresh:
        if kind == "folder":
            fresh.mkdir()
            (fresh / "data").touch()
        else:
            fresh.touch()
    content = [(fresh / "data", False)] if kind == "folder" else []
    assert synced == [*content, (fresh, False), (tmp_path, True)]


@pytest.mark.parametrize("kind", ["file", "folder"])
def test_a_failure_changes_nothing(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "page.html"
    path.write_text("old", encoding="utf-8")

    def fail() -> None:
        with atomic_write(path) as fresh:
            if kind == "folder":
                fresh.mkdir()
                (fresh / "data").touch()
            else:
                fresh.write_text("new", encoding="utf-8")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert path.read_text(encoding="utf-8") == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_and_a_file_do_not_replace_each_other(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").touch()
    with pytest.raises(IsADirectoryError), atomic_write(tmp_path / "folder") as fresh:
        fresh.touch()
    with pytest.raises(NotADirectoryError), atomic_write(tmp_path / "file") as fresh:
        fresh.mkdir()
    assert sorted(item.name for item in tmp_path.iterdir()) == ["file", "folder"]


def test_a_link_to_an_earlier_folder_is_replaced_and_its_folder_left(tmp_path: Path) -> None:
    (tmp_path / "disk").mkdir()
    (tmp_path / "out").symlink_to(tmp_path / "disk")
    with atomic_write(tmp_path / "out") as fresh:
        fresh.mkdir()
    assert not (tmp_path / "out").is_symlink()
    assert sorted(item.name for item in tmp_path.iterdir()) == ["disk", "out"]


@pytest.mark.parametrize("kind", ["partial", "old"])
def test_what_the_dead_left_is_cleared_and_what_the_living_write_is_not(
    tmp_path: Path, dead: int, kind: str
) -> None:
    path = tmp_path / "x.json"
    path.touch()
    ours, theirs = sibling(path, os.getpid(), kind), sibling(path, dead, kind)
    elsewhere = path.with_name(f".x.another-{dead}-0123abcd.{kind}.json")
    other = sibling(tmp_path / "y.json", dead, kind)
    for item in (ours, theirs, elsewhere, other):
        item.mkdir()
        (item / "data").touch()
    with atomic_write(path) as fresh:
        fresh.touch()
    assert sorted(tmp_path.iterdir()) == sorted([path, ours, elsewhere, other])


def test_an_earlier_folder_that_lost_its_name_has_it_back(tmp_path: Path, dead: int) -> None:
    path = tmp_path / "result"
    sibling(path, dead, "old").mkdir()
    (sibling(path, dead, "old") / "metrics.json").touch()
    sibling(path, os.getpid(), "old").mkdir()
    recover(path)
    assert [item.name for item in path.iterdir()] == ["metrics.json"]
    recover(tmp_path / "nothing" / "at all")


def test_another_user_s_process_is_alive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def kill(_: int, signal: int) -> None:
        assert signal == 0
        raise PermissionError

    monkeypatch.setattr(os, "kill", kill)
    sibling(tmp_path / "x", 1).touch()
    recover(tmp_path / "x")
    assert sibling(tmp_path / "x", 1).exists()


def test_no_library_call_for_an_exchange(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ctypes.CDLL", lambda *_, **__: object())
    for text in ("old", "new"):
        with atomic_write(tmp_path / "x") as fresh:
            fresh.mkdir()
            (fresh / text).touch()
    assert [item.name for item in tmp_path.rglob("*")] == ["x", "new"]


def test_a_second_rename_that_fails_gives_the_name_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, rename = tmp_path / "x", Path.rename
    path.mkdir()
    (path / "old").touch()

    def full(item: Path, target: Path) -> Path:
        if ".partial" in item.name:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return rename(item, target)

    monkeypatch.setattr("ctypes.CDLL", lambda *_, **__: object())
    monkeypatch.setattr(Path, "rename", full)
    with (
        pytest.raises(ArenaError, match=r"cannot write .*No space left"),
        atomic_write(path, ArenaError) as fresh,
    ):
        fresh.mkdir()
    assert [item.name for item in tmp_path.rglob("*")] == ["x", "old"]


def test_what_cannot_be_written_is_one_sentence_or_the_system_s_error(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(ArenaError, match="cannot write"), atomic_write(tmp_path / "file" / "x", ArenaError):
        pass
    with pytest.raises(FileExistsError), atomic_write(tmp_path / "file" / "x"):
        pass


def test_what_is_there_is_left_alone(tmp_path: Path) -> None:
    check_absent(tmp_path / "new", ArenaError)
    (tmp_path / "lost").symlink_to(tmp_path / "gone")
    for path in (tmp_path, tmp_path / "lost"):
        with pytest.raises(ArenaError, match="exists already and is left as it is"):
            check_absent(path, ArenaError)
        with pytest.raises(FileExistsError), atomic_write(path, overwrite=False):
            pytest.fail("nothing is done in vain")


def test_what_came_in_between_is_left_alone(tmp_path: Path) -> None:
    path = tmp_path / "x"
    with (
        pytest.raises(ArenaError, match="File exists"),
        atomic_write(path, ArenaError, overwrite=False) as fresh,
    ):
        fresh.touch()
        path.write_text("mine", encoding="utf-8")
    assert [item.read_text(encoding="utf-8") for item in tmp_path.iterdir()] == ["mine"]
