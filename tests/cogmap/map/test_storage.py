from pathlib import Path

import numpy as np
import pytest
import torch

from cogmap import CogmapError, CognitiveMap
from cogmap.map.storage import read_state, write_state

WEIGHTS = {"a": torch.arange(6.0).reshape(2, 3), "b": torch.tensor(7)}


def test_round_trip(tmp_path: Path) -> None:
    write_state(tmp_path / "map", WEIGHTS, {"charts": 3}, {"odorants": 2})
    weights, settings, learnt = read_state(tmp_path / "map")
    assert all(torch.equal(weights[name], WEIGHTS[name]) for name in WEIGHTS)
    assert (settings, learnt) == ({"charts": 3}, {"odorants": 2})
    assert [entry.name for entry in tmp_path.iterdir()] == ["map"]


@pytest.mark.parametrize(
    "damage", ["missing", "no weights", "junk weights", "junk json", "other version", "list"]
)
def test_damage_is_told_in_one_line(tmp_path: Path, damage: str) -> None:
    path = tmp_path / "map"
    write_state(path, WEIGHTS, {}, {})
    if damage == "missing":
        path = tmp_path / "nothing"
    elif damage == "no weights":
        (path / "weights.safetensors").unlink()
    elif damage == "junk weights":
        (path / "weights.safetensors").write_bytes(b"junk" * 100)
    else:
        text = {"junk json": "{", "other version": '{"version": 99}', "list": "[]"}[damage]
        (path / "map.json").write_text(text, encoding="utf-8")
    with pytest.raises(CogmapError) as caught:
        CognitiveMap.load(path)
    assert "\n" not in str(caught.value)


def test_weights_of_another_size_are_refused(tmp_path: Path) -> None:
    write_state(tmp_path / "map", WEIGHTS, {}, {"view_shape": [15, 90, 3], "odorants": 3, "epoch": 5})
    with pytest.raises(CogmapError, match="whole map"):
        CognitiveMap.load(tmp_path / "map")


def test_nothing_is_left_when_writing_fails(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(CogmapError, match="cannot write"):
        write_state(tmp_path / "file" / "map", WEIGHTS, {}, {})
    assert [entry.name for entry in tmp_path.iterdir()] == ["file"]


def test_another_version_is_told(tmp_path: Path) -> None:
    write_state(tmp_path / "map", WEIGHTS, {}, {})
    (tmp_path / "map" / "map.json").write_text('{"version": 2}', encoding="utf-8")
    with pytest.raises(CogmapError, match="map of version 2, not 8; learn it again, or load it with"):
        read_state(tmp_path / "map")


def test_numbers_of_numpy_are_saved_and_what_is_none_is_refused(tmp_path: Path) -> None:
    settings = {"charts": np.int64(3), "smell": np.float32(0.5), "first": np.bool_(1)}
    write_state(tmp_path / "map", WEIGHTS, settings, {})
    assert read_state(tmp_path / "map")[1] == {"charts": 3, "smell": 0.5, "first": True}
    with pytest.raises(CogmapError, match="cannot be saved"):
        write_state(tmp_path / "other", WEIGHTS, {"charts": {1, 2}}, {})
    assert not (tmp_path / "other").exists()


def test_a_tilde_is_the_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    write_state("~/map", WEIGHTS, {}, {})
    assert read_state(Path("~/map"))[1:] == ({}, {})
    assert (tmp_path / "map").is_dir()
