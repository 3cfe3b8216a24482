"""Paths as people type them, and the first bytes that some editors write."""

from pathlib import Path

from arena.errors import ArenaError

BYTE_ORDER_MARK = "\ufeff"
"""What some editors write before the first character of a text."""


def user_path(path: str | Path) -> Path:
    """Give a path in which `~` or `~user` at the beginning stands for a home.

    Raises
    ------
    ArenaError
        Where there is no such home.
    """
    try:
        return Path(path).expanduser()
    except RuntimeError:
        raise ArenaError(f"{path} begins with a home that is not known here; give the whole path") from None
