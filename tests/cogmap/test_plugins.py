"""An experiment, a motion, a material and a body, one file each in another package, are found everywhere."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

FILES = {
    "motions/hop.py": """
from arena.motions.rotation import Rotation

class Hop(Rotation):
    "Hops on the spot."
    height: float = 0.1
""",
    "bodies/marble.py": """
from arena.bodies.disc import Disc

class Marble(Disc):
    "Small and round."
    radius: float = 0.02
""",
    "recipes/felt.py": """
import numpy as np
from arena.rooms.materials import TILE

def paint(rng):
    return np.broadcast_to(rng.uniform(0, 255, 3), (*TILE, 3))
""",
    "experiments/weigh.py": """
from arena import Brownian, Camera
from cogmap.experiments.registry import experiment
from cogmap.experiments.result import Result

@experiment(room="pillar", views=300, takes=("motion", "body"))
def weigh(conditions):
    "Weigh an animal."
    walk = conditions.explore(Brownian(), Camera.panoramic(12, 2), views=20)
    return Result({key: walk.attributes[key] for key in ("motion", "body")})
""",
}
GROUPS = {
    "arena.motions": "lab.motions",
    "arena.bodies": "lab.bodies",
    "arena.rooms.recipes": "lab.recipes",
    "cogmap.experiments": "lab.experiments",
}
SCRIPT = """
import contextlib, io, json, sys
from cogmap import Plan, cli
from cogmap.pages.report.contents import read_contents
from cogmap.sweeps.points import points_of
from pathlib import Path

def run(*words):
    sys.argv = ["cogmap", *words]
    with contextlib.redirect_stdout(io.StringIO()) as out:
        cli.main()
    return out.getvalue()

grid = {"motion": "hop", "motion.height": 0.2, "body": "marble", "body.radius": 0.03}
(point,) = points_of(Plan.create(experiment="weigh", points=[grid]))
json.dump(
    {
        "help": run("experiment", "--help"),
        "list": json.loads(run("experiment", "--list", "--json")),
        "explore": run("explore", "--help"),
        "walk": json.loads(run("explore", "felt.toml", "--motion", "hop", "--body", "marble", "--views", "5",
                               "--width", "12", "--height", "2", "--out", "w.zarr", "--json")),
        "schema": json.loads(run("arena", "--schema")),
        "metrics": json.loads(run("experiment", "weigh", "--out", "out", "--json")),
        "summary": read_contents(Path("out")).summary,
        "point": {name: repr(part) for name, part in point.overrides.items()},
    },
    sys.stdout,
)
"""


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("site")
    for name, text in FILES.items():
        (folder / "lab" / name).parent.mkdir(parents=True)
        (folder / "lab" / name).with_name("__init__.py").write_text('"""Things of a lab."""\n', "utf-8")
        (folder / "lab" / name).write_text(text, "utf-8")
    (folder / "lab" / "__init__.py").touch()
    info = folder / "lab-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: lab\nVersion: 1.0\n", "utf-8")
    points = "".join(f"[{group}]\nlab = {value}\n" for group, value in GROUPS.items())
    (info / "entry_points.txt").write_text(points, "utf-8")
    room = (Path(__file__).parents[2] / "arena" / "gallery" / "open_field.toml").read_text("utf-8")
    (folder / "felt.toml").write_text(room.replace('material = "brick"', 'material = "felt"', 1), "utf-8")
    assert '"felt"' in (folder / "felt.toml").read_text("utf-8")
    path = os.pathsep.join([str(folder), str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    result: dict[str, Any] = json.loads(done.stdout)
    return result


def test_the_experiment_is_on_the_command_line_and_in_the_report(said: dict[str, Any]) -> None:
    assert "weigh: Weigh an animal." in said["help"]
    assert "Things of a lab." in said["help"]
    (entry,) = [entry for entry in said["list"] if entry["experiment"] == "weigh"]
    assert (entry["what it does"], entry["room"], entry["views"]) == ("Weigh an animal.", "pillar", "300")
    assert entry["takes"] == "arena, motion, body"
    assert said["metrics"]["motion"]["kind"] == "Brownian"
    assert said["summary"] == "Weigh an animal."


def test_motion_and_body_can_be_chosen_and_swept(said: dict[str, Any]) -> None:
    assert "hop" in said["explore"]
    assert "marble" in said["explore"]
    assert said["walk"]["views"] == 5
    assert "height=0.2" in said["point"]["motion"]
    assert "radius=0.03" in said["point"]["body"]


def test_the_material_is_in_the_schema_and_on_a_wall(said: dict[str, Any]) -> None:
    assert "felt" in said["schema"]["$defs"]["Material"]["enum"]
