from pathlib import Path

import pytest

from arena import ArenaError, Brownian
from arena.bodies.catalogue import bodies
from arena.motions.catalogue import motions
from arena.registry import modules_of, named_by_file, settings_with


def plugin(folder: Path, monkeypatch: pytest.MonkeyPatch, value: str, group: str = "arena.motions") -> None:
    """Install a distribution that names a plugin."""
    info = folder / "lab-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: lab\nVersion: 1.0\n", "utf-8")
    (info / "entry_points.txt").write_text(f"[{group}]\nlab = {value}\n", "utf-8")
    monkeypatch.syspath_prepend(folder)


def test_all_that_is_there_is_found() -> None:
    assert list(motions()) == [
        "babble", "brownian", "chemotaxis", "cyclic", "replay", "rotation", "slow_turning", "track"
    ]  # fmt: skip
    assert motions()["brownian"] is Brownian
    assert list(bodies()) == ["arm", "disc", "heavy_disc", "neck", "rail", "turntable"]


def test_a_plugin_is_looked_through_to_the_bottom(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    below = tmp_path / "lab_deep" / "below"
    below.mkdir(parents=True)
    (below.parent / "__init__.py").touch()
    (below / "__init__.py").touch()
    (below / "still.py").write_text(
        "from arena.motions.rotation import Rotation\nclass Still(Rotation): 'Stays.'\n", "utf-8"
    )
    (below / "helper.py").write_text("from arena.motions.rotation import Rotation\n", "utf-8")
    plugin(tmp_path, monkeypatch, "lab_deep")
    assert [module.__name__ for module in modules_of("arena.motions")][-4:] == [
        "lab_deep", "lab_deep.below", "lab_deep.below.helper", "lab_deep.below.still"
    ]  # fmt: skip
    found = named_by_file("arena.motions", settings_with("walk"))
    assert found.keys() - motions().keys() == {"still"}
    assert list(found) == sorted(found)


def test_two_of_one_name_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "track.py").write_text(
        "from arena.motions.rotation import Rotation\nclass Mine(Rotation): 'Mine.'\n", "utf-8"
    )
    plugin(tmp_path, monkeypatch, "track")
    with pytest.raises(ArenaError, match=r"two files of arena.motions are called track; .*track.py"):
        named_by_file("arena.motions", settings_with("walk"))


def test_a_plugin_that_is_not_there_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plugin(tmp_path, monkeypatch, "lab_gone")
    with pytest.raises(ArenaError, match=r"the plugin 'lab_gone' of arena.motions cannot be imported"):
        list(modules_of("arena.motions"))
