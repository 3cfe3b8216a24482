"""Paths as people type them, and the first bytes that some editors write."""

from pathlib import Path

BYTE_ORDER_MARK = "\ufeff"
"""What some editors write before the first character of a text."""


def user_path(path: str | Path, error: type[Exception]) -> Path:
    """Give a path in which `~` or `~user` at the beginning stands for a home.

    Parameters
    ----------
    path
        As it was typed.
    error
        Raised where there is no such home.
    """
    try:
        return Path(path).expanduser()
    except RuntimeError:
        raise error(f"{path} begins with a home that is not known here; give the whole path") from None
