from pathlib import Path

import pytest

from cogmap import CogmapError
from cogmap.atomic import METRICS, atomic_write, result_folder, user_path


def test_what_cannot_be_written_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(CogmapError, match="cannot write"), atomic_write(tmp_path / "file" / "page.html"):
        pass


def test_a_result_appears_whole_and_replaces_an_earlier_one(tmp_path: Path) -> None:
    out = tmp_path / "deep" / "result"
    for text in ("first", "second"):
        with result_folder(out) as folder:
            (folder / METRICS).write_text(text, encoding="utf-8")
            assert not out.exists() or (out / METRICS).read_text(encoding="utf-8") == "first"
        assert (out / METRICS).read_text(encoding="utf-8") == text
    assert [entry.name for entry in out.parent.iterdir()] == ["result"]


def test_a_failure_changes_no_result(tmp_path: Path) -> None:
    out = tmp_path / "result"
    with result_folder(out) as folder:
        (folder / METRICS).write_text("kept", encoding="utf-8")
    with pytest.raises(RuntimeError, match="boom"), result_folder(out) as folder:
        (folder / METRICS).write_text("lost", encoding="utf-8")
        raise RuntimeError("boom")
    assert (out / METRICS).read_text(encoding="utf-8") == "kept"
    assert [entry.name for entry in tmp_path.iterdir()] == ["result"]


def test_other_peoples_folders_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / "diary.txt").write_text("mine", encoding="utf-8")
    with pytest.raises(CogmapError, match="not the result"), result_folder(tmp_path):
        pass
    with pytest.raises(CogmapError, match="not the result"), result_folder(tmp_path / "diary.txt"):
        pass
    assert [entry.name for entry in tmp_path.iterdir()] == ["diary.txt"]


def test_an_unknown_home_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    assert user_path("~/map") == tmp_path / "map"
    with pytest.raises(CogmapError, match="~nobody-of-this-name/map begins with a home that is not known"):
        user_path("~nobody-of-this-name/map")
