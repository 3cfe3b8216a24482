"""Atomic writes: results and maps that appear under their name only when they are whole."""

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

from cogmap.digests import SUMS, sums
from cogmap.errors import CogmapError

METRICS = "metrics.json"
"""What every finished experiment leaves, and what marks a folder as one."""


def user_path(path: str | Path) -> Path:
    """Give a path in which `~` or `~user` at the beginning stands for a home.

    Raises
    ------
    CogmapError
        Where there is no such home.
    """
    try:
        return Path(path).expanduser()
    except RuntimeError:
        raise CogmapError(f"{path} begins with a home that is not known here; give the whole path") from None


def atomic_write(path: Path, *, overwrite: bool = True) -> AbstractContextManager[Path]:
    """Write as `arena.atomic.atomic_write` does, and raise a `CogmapError` when it cannot be done."""
    # Only when something is written: a map that grows in memory does without the arena and its compiler.
    from arena import atomic  # noqa: PLC0415

    return atomic.atomic_write(path, CogmapError, overwrite=overwrite)


def check_replaceable(out: Path, mark: str, wanted: str, beside: tuple[str, ...] = ()) -> None:
    """Raise unless `out` is free, or a folder that has a file `mark` or holds nothing but `beside`."""
    if not out.exists() and not out.is_symlink():
        return
    if not out.is_dir() or not ((out / mark).is_file() or {item.name for item in out.iterdir()} <= {*beside}):
        raise CogmapError(f"{out} exists and is not {wanted}")


@contextmanager
def result_folder(out: str | Path) -> Iterator[Path]:
    """Give a folder to fill, which takes the place of `out` at the end; a failure changes nothing.

    `SHA256SUMS` in it has the digests of all its files.

    Raises
    ------
    CogmapError
        When `out` holds anything but an earlier result, or cannot be written.
    """
    out = user_path(out)
    check_replaceable(out, METRICS, "the result of an experiment; choose another folder")
    with atomic_write(out) as folder:
        folder.mkdir()
        yield folder
        files = [file for file in folder.rglob("*") if file.is_file()]
        (folder / SUMS).write_text(sums(folder, files), encoding="utf-8")
