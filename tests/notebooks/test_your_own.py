"""The data beside notebook 11, and the commands that it ends with."""

import re
import runpy
import shlex
import sys
from contextlib import suppress
from pathlib import Path

import cv2
import nbformat
import numpy as np
import pandas as pd
import pytest

from arena import Arena, Recording, Replay, explore
from arena.bodies.disc import Disc
from arena.eye.camera import Camera
from cogmap import cli
from tests.notebooks.test_notebooks import OWN, ROOT

(NOTEBOOK,) = (ROOT / "notebooks").glob("11_*.ipynb")


def frames(folder: Path) -> np.ndarray:
    return np.stack([cv2.imread(str(path)) for path in sorted(folder.glob("*.jpg"))])


def test_they_are_made_again_and_are_small(tmp_path: Path) -> None:
    runpy.run_path(str(OWN / "make.py"))["make"](tmp_path)
    for table in ("robot/signals.csv", "robot/poses.csv", "rat/track.csv", "rat/spikes.csv"):
        pd.testing.assert_frame_equal(pd.read_csv(tmp_path / table), pd.read_csv(OWN / table))
    shipped, made = (frames(folder / "robot" / "frames").astype(int) for folder in (OWN, tmp_path))
    # Another coder of JPEG rounds in another way.
    assert np.abs(shipped - made).mean() < 0.5
    files = [path for path in OWN.rglob("*") if path.is_file() and "__pycache__" not in path.parts]
    assert sum(path.stat().st_size for path in files) < 1_600_000
    assert len(list(tmp_path.rglob("*.*"))) == len(files) - len(["make.py", "README.md", "box.toml"])


def test_the_commands_give_what_the_notebook_shows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / OWN.name).symlink_to(OWN)
    monkeypatch.chdir(tmp_path)
    cells = nbformat.read(NOTEBOOK, 4).cells
    (commands,) = re.findall(r"```sh\n(.*?)```", cells[-1].source, re.DOTALL)
    for command in commands.splitlines():
        if " learn " in command:  # as its first half does
            continue
        few = ["--shuffles", "10"] if " cells " in command else []
        monkeypatch.setattr(sys, "argv", [*shlex.split(command), *few])
        with suppress(SystemExit):
            cli.main()
        assert not capsys.readouterr().err, command
    assert Recording.open("run.zarr").signals.keys() == {"kitchen", "hall", "office", "stairs"}
    shown = "".join(output.get("text", "") for cell in cells for output in cell.get("outputs", []))
    table = pd.read_csv("rat/cells.csv").set_index("cell")
    assert table.index[table["place_passing"]].tolist() == [f"p{cell:02}" for cell in range(1, 17)]
    assert table.index[table["heading_passing"]].tolist() == [f"h{cell}" for cell in range(1, 7)]
    assert "spikes: 14309" in shown
    assert "18" in re.findall(r"'too_fast': (\d+)", shown)


def test_the_rat_goes_through_its_box() -> None:
    told = Replay(
        path=OWN / "rat" / "track.csv", rate=20, y_down=True, heading="head_deg", missing=-1, fastest=1.5,
        calibration=((120, 40), (520, 40), 1.0), interval=5,
    )  # fmt: skip
    eye, box = Camera.panoramic(24, 4), Arena.load(OWN / "rat" / "box.toml")
    walk = explore(box, told, eye, body=Disc(radius=0.03))
    assert len(walk) == 120
    assert walk.attributes["walk"]["too_fast"] == 18
