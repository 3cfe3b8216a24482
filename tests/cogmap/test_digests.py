import subprocess
from pathlib import Path

import pytest

from cogmap.digests import SUMS, compare_sums, digest, sums


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "in").mkdir()
    for name in ("b", "a", "in/Ä"):
        (tmp_path / name).write_text(name, encoding="utf-8")
    files = [file for file in tmp_path.rglob("*") if file.is_file()]
    (tmp_path / SUMS).write_text(sums(tmp_path, files), encoding="utf-8")
    return tmp_path


def test_digest_is_of_what_json_says() -> None:
    assert digest({"b": (1, 2), 10: 1, 9: 2}) == digest({"9": 2, "10": 1, "b": [1, 2]})
    assert digest({"a": 1}) != digest({"a": 1.0})


def test_others_read_the_sums(folder: Path) -> None:
    assert [line[66:] for line in (folder / SUMS).read_text("utf-8").splitlines()] == ["a", "b", "in/Ä"]
    told = subprocess.run(["sha256sum", "--check", SUMS], cwd=folder, check=False)  # noqa: S607
    assert told.returncode == 0


def test_what_is_not_what_was_written_is_named(folder: Path) -> None:
    assert compare_sums(folder) == (["a", "b", "in/Ä"], [])
    (folder / "a").write_text("c", encoding="utf-8")
    (folder / "b").unlink()
    (folder / "another").write_text("", encoding="utf-8")
    assert compare_sums(folder) == (["in/Ä"], ["'a' is not what was written", "'b' cannot be read"])
    (folder / SUMS).write_bytes(b"\xff")
    whole, (damage,) = compare_sums(folder)
    assert not whole
    assert damage == f"{SUMS}, which says what was written, cannot be read"
