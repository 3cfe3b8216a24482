import json
import platform
import shlex
from pathlib import Path

import numpy as np
import pytest

from arena import Arena, Nose
from cogmap import cli
from cogmap.experiments.provenance import ROOM, write_provenance
from cogmap.experiments.registry import Experiment, experiments, run_experiment
from cogmap.experiments.result import Result


def written(folder: Path) -> dict:
    return json.loads((folder / "about.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("where", ["--arena open_field ", ""])
def test_the_command_repeats_the_result(where: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    quick = Experiment(
        lambda conditions: Result({"room": conditions.room.to_toml()}),
        "open_field",
        4000,
        any_room=bool(where),
    )
    monkeypatch.setitem(experiments(), "cyclic", quick)
    first, second = tmp_path / "first", tmp_path / "second"
    run_experiment("cyclic", first, views=200, seed=3)
    command = shlex.split(written(first)["command"])
    assert " ".join(command) == f"cogmap experiment cyclic {where}--views 200 --seed 3"
    monkeypatch.setattr("sys.argv", [*command, "--out", str(second)])
    cli.main()
    for name in ("metrics.json", "about.json"):
        assert (first / name).read_bytes() == (second / name).read_bytes()
    assert written(first)["different"] == {}


def test_a_room_of_ones_own_is_kept_and_named(tmp_path: Path) -> None:
    room = Arena.load("furnished")
    own = room.model_copy(update={"boxes": room.boxes[:1]})
    write_provenance(tmp_path, ("demo",), own, seed=0)
    assert written(tmp_path)["command"] == f"cogmap demo --arena {ROOM} --seed 0"
    assert Arena.load(str(tmp_path / ROOM)) == own


def test_versions_and_what_no_command_says(tmp_path: Path) -> None:
    write_provenance(tmp_path, ("experiment", "fusion"), Arena.load("pillar"), nose=Nose(noise=0.3), seed=1)
    about = written(tmp_path)
    assert about["command"] == "cogmap experiment fusion --arena pillar --seed 1"
    assert "0.3" in about["different"]["nose"]
    assert about["versions"]["python"] == platform.python_version()
    assert about["versions"]["numpy"] == np.__version__
    assert not (tmp_path / ROOM).exists()
