"""Digests: what settings and files were when they were written, in a few characters."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

SUMS = "SHA256SUMS"
"""Digests of the files of a folder, which `sha256sum -c SHA256SUMS` reads, too."""


def digest(described: Any) -> str:
    """Give the SHA-256 of what JSON says of it, whatever its spaces and the order of its keys."""
    # there and back first: keys that are numbers become text, which is sorted otherwise
    text = json.dumps(json.loads(json.dumps(described)), sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def sums(folder: Path, files: Iterable[Path]) -> str:
    """Give what `SUMS` says of these files of a folder."""
    return "".join(f"{_sha256(file)}  {file.relative_to(folder).as_posix()}\n" for file in sorted(files))


def compare_sums(folder: Path) -> tuple[list[str], list[str]]:
    """Compare the files of a folder with what `SUMS` says of them.

    Returns
    -------
    list
        Names of those that are what was written.
    list
        What is not, each in a clause.
    """
    whole, damage = list[str](), list[str]()
    try:
        lines = (folder / SUMS).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return whole, [f"{SUMS}, which says what was written, cannot be read"]
    for line in lines:
        wanted, _, name = line.partition("  ")
        try:
            found = _sha256(folder / name)
        except (OSError, ValueError):
            damage.append(f"{name!r} cannot be read")
        else:
            if found == wanted:
                whole.append(name)
            else:
                damage.append(f"{name!r} is not what was written")
    return whole, damage


def _sha256(file: Path) -> str:
    with file.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
