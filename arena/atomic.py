"""Atomic writes: a file or folder takes its name when it is whole and on the disk."""

import ctypes
import errno
import os
import re
import secrets
import shutil
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def atomic_write(
    path: Path, error: type[Exception] | None = None, *, overwrite: bool = True
) -> Iterator[Path]:
    """Give a path beside `path` to write a file or make a folder at, which takes its name at the end.

    A failure changes nothing. Whoever is killed, at whatever moment, leaves what was there or what is new,
    whole; where the kernel cannot exchange two folders, an earlier folder may need `recover` to have its name
    back. What was left by others that were killed is cleared away first.

    Parameters
    ----------
    path
        What to write; its parents are made.
    error
        Raised, with a sentence, in place of an `OSError`; None lets that through.
    overwrite
        Whether a file is to replace a file that is there, and a folder a folder; else nothing may be there.
    """
    recover(path)
    if not overwrite:
        check_absent(path, error or FileExistsError)
    fresh = _sibling(path, "partial")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield fresh
        # Without these the name may reach the disk before the content, and a power cut leaves it empty.
        sync(fresh)
        if not overwrite and os.path.lexists(path):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(path))
        if path.is_dir() and fresh.is_dir():
            _exchange(fresh, path)
        else:
            fresh.replace(path)
        _sync(path.parent)
    except OSError as failed:
        if error is None:
            raise
        raise error(f"cannot write {path}: {failed.strerror or failed}") from None
    finally:
        _remove(fresh)


def sync(path: Path) -> None:
    """Wait until a file, or a folder with all that is in it, is on the disk."""
    for item in (*path.rglob("*"), path):
        _sync(item)


def recover(path: Path) -> None:
    """Clear away what killed processes left beside `path`, and give an earlier folder its name back.

    What processes of other machines left stays: nobody here can tell whether they live.
    """
    name = re.escape(path.stem), re.escape(socket.gethostname()), re.escape(path.suffix)
    left_by = re.compile(r"\.{}\.{}-(\d+)-[0-9a-f]+\.(partial|old){}".format(*name))
    with suppress(OSError):  # the parent may be missing, and another process may recover at the same time
        # Names, not paths: beside a point of a sweep lie thousands of others.
        for found in filter(None, map(left_by.fullmatch, os.listdir(path.parent))):  # noqa: PTH208
            item = path.with_name(found.string)
            if _is_running(int(found[1])):
                continue
            if found[2] == "old" and not os.path.lexists(path):
                item.rename(path)
            else:
                _remove(item)


def check_absent(path: Path, error: type[Exception]) -> None:
    """Raise when there is something at a path already."""
    if os.path.lexists(path):
        raise error(f"{path} exists already and is left as it is; choose another path or remove it first")


def _sibling(path: Path, kind: str) -> Path:
    """Name a hidden neighbour by its maker: machine, process and, for its threads, a random number."""
    maker = f"{socket.gethostname()}-{os.getpid()}-{secrets.token_hex(4)}"
    return path.with_name(f".{path.stem}.{maker}.{kind}{path.suffix}")


def _exchange(fresh: Path, path: Path) -> None:
    """Swap two folders in one step if the kernel can, else in two, between which `recover` helps."""
    try:
        # AT_FDCWD is -100, RENAME_EXCHANGE is 2.
        failed = ctypes.CDLL(None, use_errno=True).renameat2(
            -100, os.fsencode(fresh), -100, os.fsencode(path), 2
        )
    except AttributeError:  # a C library without it
        failed = -1
        ctypes.set_errno(errno.ENOSYS)
    if not failed:
        return
    if (code := ctypes.get_errno()) not in {errno.ENOSYS, errno.EINVAL, errno.ENOTSUP}:
        raise OSError(code, os.strerror(code), str(path))
    old = _sibling(path, "old")
    path.rename(old)
    try:
        fresh.rename(path)
    except OSError:
        old.rename(path)
        raise
    _remove(old)


def _sync(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    except OSError as failed:
        if not (path.is_dir() and failed.errno == errno.EINVAL):  # network disks that cannot sync a folder
            raise
    finally:
        os.close(descriptor)


def _is_running(process: int) -> bool:
    try:
        with suppress(PermissionError):  # another user's
            os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    return True


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path, ignore_errors=True)
    else:
        with suppress(OSError):
            path.unlink()
