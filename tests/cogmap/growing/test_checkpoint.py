import shutil
from pathlib import Path

import pytest
from filelock import FileLock

from cogmap import CogmapError, CognitiveMap
from cogmap.growing.checkpoint import Checkpoint, Place


def begun(folder: Path) -> Checkpoint:
    checkpoint = Checkpoint.beside(folder / "map")
    with pytest.raises(KeyboardInterrupt), checkpoint.opened({"seed": 3}):
        raise KeyboardInterrupt
    return checkpoint


def test_what_is_put_down_last_is_found_and_put_away_at_the_end(undisturbed: Path, tmp_path: Path) -> None:
    checkpoint, cmap = begun(tmp_path), CognitiveMap.load(undisturbed)
    assert checkpoint.load() is None
    with checkpoint.opened({"seed": 3}):
        checkpoint.save(cmap, Place("charts", 0))
        checkpoint.save(cmap, Place("olfaction", 2))
        found = checkpoint.load()
        assert found is not None
        assert found[1] == Place("olfaction", 2)
        assert found[0].state_dict().keys() == cmap.state_dict().keys()
        with checkpoint.lent("olfaction", lambda: cmap) as path:
            assert CognitiveMap.load(path).charts == cmap.charts
        assert not path.exists()
    assert not checkpoint.folder.exists()


def test_a_map_that_is_lent_is_put_down_once(undisturbed: Path, tmp_path: Path) -> None:
    checkpoint, cmap = begun(tmp_path), CognitiveMap.load(undisturbed)
    with pytest.raises(KeyboardInterrupt), checkpoint.lent("olfaction", lambda: cmap):
        raise KeyboardInterrupt
    with checkpoint.lent("olfaction", lambda: pytest.fail("it is there")) as path:
        assert path.exists()


def test_killed_while_it_is_put_away_nothing_stands_in_the_way(
    undisturbed: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    checkpoint, cmap = begun(tmp_path), CognitiveMap.load(undisturbed)

    def torn(folder: Path, **_: object) -> None:
        for file in folder.rglob("map.json"):
            file.unlink()
            raise KeyboardInterrupt

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(shutil, "rmtree", torn)
        with checkpoint.lent("olfaction", lambda: cmap):
            pass
    with checkpoint.lent("olfaction", lambda: cmap) as path:
        assert CognitiveMap.load(path).charts == cmap.charts
    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(shutil, "rmtree", torn)
        with checkpoint.opened({"seed": 3}):
            checkpoint.save(cmap, Place("charts", 0))
    with checkpoint.opened({"seed": 3}):
        pass
    assert not checkpoint.folder.exists()


def test_one_command_at_a_time(tmp_path: Path) -> None:
    checkpoint = begun(tmp_path)
    with FileLock(checkpoint.folder / "lock"), pytest.raises(CogmapError, match="another command grows"):
        checkpoint.opened({"seed": 3}).__enter__()


def test_another_plan_is_refused(tmp_path: Path) -> None:
    checkpoint = begun(tmp_path)
    with pytest.raises(CogmapError, match="another map that grows, of a different seed"):
        checkpoint.opened({"seed": 4}).__enter__()


@pytest.mark.parametrize("text", ["{", "[]", '{"seed": 3}'])
def test_a_plan_that_is_damaged_is_said(text: str, tmp_path: Path) -> None:
    checkpoint = begun(tmp_path)
    (checkpoint.folder / "growing.json").write_text(text, encoding="utf-8")
    with pytest.raises(CogmapError, match=r"growing\.json is damaged; remove"):
        checkpoint.opened({"seed": 3}).__enter__()


def test_damage_to_what_was_put_down_is_said(undisturbed: Path, tmp_path: Path) -> None:
    checkpoint, cmap = begun(tmp_path), CognitiveMap.load(undisturbed)
    checkpoint.save(cmap, Place("charts", 0))
    (checkpoint.folder / "now" / "place.json").write_text("{}", encoding="utf-8")
    with pytest.raises(CogmapError, match="now is damaged; remove"):
        checkpoint.load()


def test_what_is_not_ours_is_left_alone(tmp_path: Path) -> None:
    folder = tmp_path / "map.growing"
    folder.mkdir()
    (folder / "letters").touch()
    with pytest.raises(CogmapError, match="is in the way"):
        Checkpoint(folder).opened({}).__enter__()
    assert [file.name for file in folder.iterdir()] == ["letters"]


def test_a_folder_that_cannot_be_written_is_said(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(CogmapError, match="cannot write to"):
        Checkpoint(tmp_path / "file" / "map.growing").opened({}).__enter__()
