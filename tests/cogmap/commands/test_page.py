import json
import socket
import sys
from pathlib import Path
from typing import Any

import cv2
import pytest

from arena import Arena, Arm, Babble, Overhead, explore
from cogmap import cli
from cogmap.coordinates import GeneralisedCoordinates
from cogmap.pages.live.posture import Mechanism
from cogmap.pages.live.world import World

pytest.importorskip("nicegui")

from cogmap.pages.live import server


@pytest.fixture(scope="module")
def kept(refined: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A refined map, its walk, another walk, and a motor model."""
    folder = tmp_path_factory.mktemp("kept")
    refined.cmap.save(folder / "map")
    refined.walk.save(folder / "walk.zarr")
    refined.walk[:50].save(folder / "rat.zarr")
    refined.motor.save(folder / "motor")
    return folder


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    def call(*words: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["cogmap", *map(str, words)])
        try:
            cli.main()
            status = 0
        except SystemExit as stop:
            status = int(stop.code or 0)
        return status, *capsys.readouterr()

    return call


@pytest.fixture
def served(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Any, dict[str, Any]]]:
    """What would be served, and how."""
    told: list[tuple[Any, dict[str, Any]]] = []
    monkeypatch.setattr(server, "serve", lambda shown, **how: told.append((shown, how)))
    return told


def free_port() -> int:
    with socket.socket() as door:
        door.bind(("127.0.0.1", 0))
        return int(door.getsockname()[1])


def test_a_page_is_served_of_a_map_and_what_it_remembers(run, kept: Path, served: list) -> None:
    port = free_port()
    given = ["--memory", kept / "walk.zarr", "--arena", "open_field", "--motor", kept / "motor"]
    status, _, err = run("page", kept / "map", *given, "--replay", kept / "rat.zarr", "--port", port)
    assert status == 0, err
    [(world, how)] = served
    assert isinstance(world, World)
    assert how == {"port": port, "show": False}
    assert list(world.replays or {}) == ["walk", "rat"]
    assert world.mind.reacher is not None
    assert world.room.name == "open_field"


def test_a_page_is_served_of_an_arm(run, served: list, tmp_path: Path, monkeypatch) -> None:
    walk = explore(Arena.load("furnished"), Babble(), Overhead(16, 16), body=Arm(), views=20, seed=0)
    walk.save(tmp_path / "arm.zarr")
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "coordinates.json").write_text("{}")
    found = GeneralisedCoordinates()
    found.coordinates_, found.reason_ = walk.joints, ""
    monkeypatch.setattr(GeneralisedCoordinates, "load", lambda _: found)
    status, _, err = run("page", tmp_path / "arm", "--memory", tmp_path / "arm.zarr", "--port", free_port())
    assert status == 0, err
    [(mechanism, _)] = served
    assert isinstance(mechanism, Mechanism)
    assert mechanism.body == Arm()
    assert mechanism.eye == Overhead(16, 16)


def test_a_page_is_frozen(run, kept: Path, served: list, tmp_path: Path) -> None:
    out = tmp_path / "page.html"
    given = ["--memory", kept / "walk.zarr", "--freeze", out, "--poses", 8]
    status, said, err = run("page", kept / "map", *given)
    assert status == 0, err
    assert str(out.stat().st_size) in said
    assert out.read_text(encoding="utf-8").startswith("<!doctype html>")
    assert served == []


def test_a_port_that_is_taken_is_refused_before_anything_is_loaded(run, served: list) -> None:
    with socket.socket() as door:
        door.bind(("127.0.0.1", 0))
        door.listen()
        port = door.getsockname()[1]
        status, out, err = run("page", "nowhere", "--memory", "nothing", "--port", port)
    assert (status, out, served) == (2, "", [])
    assert f"port {port} cannot be had" in err
    assert run("page", "nowhere", "--memory", "nothing", "--port", 70_000)[0] == 2


def test_a_film_is_written(run, kept: Path, tmp_path: Path) -> None:
    out = tmp_path / "film.mp4"
    given = [kept / "map", "--memory", kept / "walk.zarr", "--motor", kept / "motor"]
    status, said, err = run("film", *given, "--seconds", 0.4, "--out", out, "--json")
    assert status == 0, err
    assert json.loads(said)["frames_per_second"] == 12.5
    assert cv2.VideoCapture(str(out)).get(cv2.CAP_PROP_FRAME_COUNT) == 5
    status, _, err = run("film", *given, "--out", out)
    assert status == 2
    assert "exists already" in err
