import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

Bar = tuple[str, str, Any]
"""Where a figure stands in what was found, by keys with / between; ≥, ≤, = or ≈ (rounded); what must hold."""


def look_up(found: Any, where: str) -> Any:
    for key in where.split("/"):
        found = found[key]
    return found


def holds(found: Any, sign: str, bar: Any) -> bool:
    if sign in "=≈":
        return bool((round(found) if sign == "≈" else found) == bar)
    least, most = (min(found), max(found)) if isinstance(found, list) else (found, found)
    return bool(least >= bar if sign == "≥" else most <= bar)


@pytest.fixture
def judge() -> Callable[..., None]:
    """Prints figures with their bars beside them, and fails for a bar that is not reached."""

    def print_and_demand(title: str, found: Any, bars: Sequence[Bar]) -> None:
        missed = []
        for where, sign, bar in bars:
            value = look_up(found, where)
            good = holds(value, sign, bar)
            line = f"{title}: {where} {value} {sign} {bar}{'' if good else '  NOT REACHED'}"
            sys.stdout.write(f"{line}\n")
            if not good:
                missed.append(line)
        assert not missed, "\n".join(missed)

    return print_and_demand


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system of 8 MB."""
    disk = tmp_path / "disk"
    disk.mkdir()
    made = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=8m", "tmpfs", str(disk)],  # noqa: S607
        check=False,
        capture_output=True,
    )
    if made.returncode:
        pytest.skip("mounting a small file system takes rights that this user lacks")
    yield disk
    subprocess.run(["umount", str(disk)], check=True)  # noqa: S607
