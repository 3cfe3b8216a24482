import json
import shutil
import sys
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import pytest

from arena import Arena, Camera, Recording
from cogmap import CognitiveMap, cli
from cogmap.commands import acting
from cogmap.experiments.registry import experiments
from tests.cogmap.conftest import Refined

FURNISHED = Arena.load("furnished").to_toml()


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    def call(*words: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["cogmap", *map(str, words)])
        try:
            cli.main()
        except SystemExit as stop:
            status = int(stop.code or 0)
        else:
            status = 0
        out, err = capsys.readouterr()
        return status, out, err

    return call


def refused(result: tuple[int, str, str], *words: str) -> None:
    status, out, err = result
    assert status == 2, err
    assert not out
    assert err.startswith("cogmap: ")
    assert len(err.splitlines()) == 1
    for word in words:
        assert word in err


@pytest.fixture(scope="module")
def folder(walk: Recording, cmap: CognitiveMap, tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("cli")
    walk.save(place / "walk.zarr")
    walk[:300].without_truth().save(place / "blind.zarr")
    cmap.save(place / "map")
    (place / "junk.zarr").mkdir()
    (place / "junk.zarr" / "zarr.json").write_text("junk", encoding="utf-8")
    shutil.copytree(place / "walk.zarr", place / "half.zarr")
    shards = sorted(file for file in (place / "half.zarr" / "views").rglob("*") if file.is_file())
    next(file for file in shards if file.name != "zarr.json").unlink()
    return place


def test_explore_learn_score(run, folder: Path, tmp_path: Path) -> None:
    explored = run("explore", "furnished", "--views", 400, "--width", 90, "--height", 15, "--seed", 1000,
                   "--out", tmp_path / "fresh.zarr", "--json")  # fmt: skip
    assert explored[0] == 0
    assert json.loads(explored[1])["views"] == 400
    assert run("learn", folder / "walk.zarr", "--out", tmp_path / "map", "--charts", 1100)[0] == 0
    assert CognitiveMap.load(tmp_path / "map").charts == 1100
    status, out, err = run(
        "score", tmp_path / "map", tmp_path / "fresh.zarr", "--train", folder / "walk.zarr", "--json"
    )
    assert status == 0, err
    assert json.loads(out)["heading_resultant"] > 0.95


@pytest.mark.filterwarnings("always::cogmap.errors.UntrustedMapWarning")
def test_learn_refines_or_says_why_not(run, folder: Path, tmp_path: Path) -> None:
    walk = Recording.open(folder / "walk.zarr")
    walk[np.arange(len(walk)) < 300].save(tmp_path / "few.zarr")
    status, out, err = run("learn", tmp_path / "few.zarr", "--refine", "--out", tmp_path / "map", "--json")
    assert status == 0
    assert "places are not relaxed" in err
    told = json.loads(out)
    assert told["refine_reason"] == told["reason"] != ""
    assert CognitiveMap.load(tmp_path / "map").relaxed_places_ is None


@pytest.mark.filterwarnings("always::arena.TrackWarning")
@pytest.mark.parametrize(
    ("words", "views"),
    [
        (["rotation"], 60),
        (["cyclic"], 60),
        (["track"], 60),
        (["chemotaxis", "--odorant", 2], 60),
        (["replay", "--path", "rat.csv", "--fit"], None),
        (["babble", "--body", "arm", "--set", "body.limits=one", "--set", "motion.swing_every=9"], 60),
    ],
)
def test_every_motion_explores(
    run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: list[object], views: int | None
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("rat.csv").write_text("t,x,y\n0,0,0\n0.1,10,3\n0.2,20,3\n0.4,,\n", encoding="utf-8")
    some = ["--views", views] if views else []
    status, out, err = run(
        "explore",
        "furnished",
        "--motion",
        *words,
        *some,
        "--width",
        36,
        "--height",
        6,
        "--out",
        "x.zarr",
        "--json",
    )
    assert status == 0, err
    assert json.loads(out)["views"] == (views or 3)
    assert Recording.open("x.zarr").attributes["motion"]["kind"] == str(words[0]).capitalize()


@pytest.mark.filterwarnings("always::arena.TrackWarning")
def test_how_a_track_is_read_is_set_and_what_was_judged_is_said(run, tmp_path: Path) -> None:
    angle = np.linspace(0, 6 * np.pi, 200)
    x, y = 300 + 100 * np.sin(angle), 200 + 80 * np.cos(angle)
    x[[50, 120]] = y[[50, 120]] = 1023
    rows = "".join(
        f"{k};{a};{b};{c}\n" for k, a, b, c in zip(range(200), x, y, [0.2] * 3 + [1] * 197, strict=True)
    )
    track = tmp_path / "rat.TXT"
    track.write_text("Frame;nose_x;nose_y;p\n" + rows.replace(".", ","), encoding="utf-16")
    told = {
        "x": "nose_x", "y": "nose_y", "rate": 25, "likelihood": "p", "least_likelihood": 0.5, "fastest": 5,
        "calibration": "[[0, 0], [100, 0], 1.0]", "offset": "[-3, 2]", "missing": "[0, 1023]",
        "y_down": "true",
    }  # fmt: skip
    words = [word for key, value in told.items() for word in ("--set", f"motion.{key}={value}")]
    go = [
        "explore",
        "open_field",
        "--motion",
        "replay",
        "--path",
        track,
        *words,
        "--width",
        36,
        "--height",
        6,
    ]
    status, out, err = run(*go, "--out", tmp_path / "rat.zarr", "--json")
    assert status == 0, err
    assert json.loads(out)["views"] == 197
    assert err == (
        f"cogmap: {track}: of 200 samples 5 are lost (2 missing as told, 3 unlikely); 2 gaps bridged by 2 "
        "samples, the longest of 0.08 s; 3 trimmed from the ends; scaled by 0.01 m; y turned upwards\n"
    )
    walk = Recording.open(tmp_path / "rat.zarr")
    assert walk.attributes["walk"].items() >= {"missing": 2, "unlikely": 3, "too_fast": 0}.items()
    lost = [0, 1, 2, 50, 120]
    wanted = np.delete(np.stack([x / 100 - 3, 2 - y / 100], axis=1), lost, axis=0)
    np.testing.assert_allclose(np.delete(walk.poses[:, :2], [47, 117], axis=0), wanted)
    assert run(*go, "--out", tmp_path / "rat.zarr")[2] == err
    refused(
        run(*go, "--set", "motion.y_dwn=true", "--out", tmp_path / "b.zarr"), "did you mean 'motion.y_down'"
    )
    refused(
        run(*go, "--set", "motion.fastest=0.01", "--out", tmp_path / "b.zarr"),
        "steps are faster",
        "calibration",
    )
    refused(
        run(*go, "--set", "motion.x=x", "--out", tmp_path / "b.zarr"), "has no column x; it has Frame, nose_x"
    )


def test_arena_shows_a_room(run, tmp_path: Path) -> None:
    status, out, _ = run("arena", "pillar", "--out", tmp_path / "room.png", "--json")
    assert status == 0
    assert json.loads(out)["pillars"] == 1
    assert (tmp_path / "room.png").read_bytes().startswith(b"\x89PNG")
    refused(run("arena", "pillar", "--out", tmp_path / "room.png"), "exists already")


def test_arena_writes_nothing_unasked_and_a_sheet_when_asked(
    run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    status, out, _ = run("arena", "l_shape")
    assert status == 0
    assert "free_area_m2" in out
    assert not list(tmp_path.iterdir())
    assert run("arena", "l_shape", "--sheet", "sheet.png")[0] == 0
    assert Path("sheet.png").read_bytes().startswith(b"\x89PNG")
    refused(run("arena", "pillar", "--sheet", "sheet.png"), "exists already")
    refused(run("arena", "pillar", "--out", tmp_path / "no" / "room.png"), "cannot write", "No such file")


def test_arena_schema_needs_no_room(run) -> None:
    status, out, _ = run("arena", "--schema")
    assert status == 0
    assert json.loads(out) == Arena.json_schema()
    refused(run("arena"), "no room is given", "furnished")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("walls = [", ["not TOML"]),
        ("", ["empty"]),
        (FURNISHED + "\nsofa = 3\n", ["sofa"]),
        (FURNISHED.replace("end = [\n    3.0,\n    -2.5,", "end = [\n    -3.0,\n    -2.5,"), ["zero length"]),
        (FURNISHED.replace("-1.5,\n    -1.0,", "-1.6,\n    2.2,"), ["odour source 0", "inside a wall"]),
    ],
    ids=["broken", "empty", "unknown key", "wall of zero length", "source inside a box"],
)
def test_a_bad_room_is_told_in_one_line(run, tmp_path: Path, text: str, words: list[str]) -> None:
    file = tmp_path / "room.toml"
    file.write_text(text, encoding="utf-8")
    for command in (
        ("arena", file),
        ("explore", file, "--out", tmp_path / "x"),
        ("demo", "--arena", file, "--out", tmp_path / "x"),
    ):
        refused(run(*command), *words)
    assert [entry.name for entry in tmp_path.iterdir()] == ["room.toml"]


def test_a_room_without_free_space_is_refused(run, tmp_path: Path) -> None:
    file = tmp_path / "room.toml"
    tight = Arena.load("furnished").model_copy(update={"platform": (((0, 0), (0.3, 0), (0.3, 3), (0, 3)),)})
    file.write_text(tight.to_toml(), encoding="utf-8")
    refused(run("demo", "--arena", file, "--out", tmp_path / "x"), "no free space")
    refused(run("explore", file, "--out", tmp_path / "x"), "no free space")
    assert [entry.name for entry in tmp_path.iterdir()] == ["room.toml"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["demo", "--views", 0], "views is 0"),
        (["demo", "--views", -5], "views is -5"),
        (["demo", "--charts", 0, "--views", 30], "charts is 0"),
        (["demo", "--views", "many"], "many"),
        (["demo", "--arena", "ballroom"], "ballroom"),
        (["demo", "--arena", "nowhere.toml"], "nowhere.toml"),
        (["explore", "furnished", "--views", 0], "views is 0"),
        (["explore", "furnished", "--width", -1], "width"),
        (["explore", "furnished", "--nose-noise", "nan"], "noise"),
        (["explore", "furnished", "--seed", -1], "seed"),
        (["explore", "furnished", "--motion", "waltz"], "waltz"),
        (["explore", "furnished", "--motion", "chemotaxis", "--odorant", 3], "3 odour sources"),
        (["explore", "furnished", "--motion", "replay"], "path"),
        (["explore", "furnished", "--motion", "replay", "--path", "nowhere.csv"], "nowhere.csv"),
        (["explore", "furnished", "--motion", "track", "--path", "rat.csv"], "path"),
        (["explore", "furnished", "--odorant", 1], "odorant"),
        (["explore", "furnished", "--set", "bdy.limits=one"], "did you mean 'body'"),
        (["explore", "furnished", "--set", "body.limits=one"], "body.limits"),
        (["explore", "furnished", "--body", "arm"], "Brownian steers a disc"),
        (["experiment", "rotation", "--set", "bdy=arm"], "did you mean 'body'"),
        (["experiment", "rotation", "--set", "nose.noise=0.2"], "does not take another nose"),
        (["experiment", "levitation"], "choose one of acuity"),
        (["experiment", "rotation", "--views", 3], "views is 3"),
        (["experiment", "distinguishability", "--arena", "furnished"], "rooms of its own"),
        (["dance"], "dance"),
        (["demo", "--sofa", 3], "sofa"),
    ],
)
def test_bad_words_are_told_in_one_line(run, tmp_path: Path, words: list[object], said: str) -> None:
    out = [] if words[0] == "dance" else ["--out", tmp_path / "out"]
    refused(run(*words, *out), said)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("nothing.zarr", "nothing.zarr"),
        ("junk.zarr", "junk.zarr"),
        ("half.zarr", "half-written"),
        ("map", "map"),
    ],
)
def test_a_bad_recording_is_told_in_one_line(run, folder: Path, tmp_path: Path, name: str, said: str) -> None:
    before = sorted(folder.rglob("*"))
    refused(run("learn", folder / name, "--out", tmp_path / "map"), said)
    refused(run("score", folder / "map", folder / name, "--train", folder / "walk.zarr"), said)
    assert sorted(folder.rglob("*")) == before
    assert not list(tmp_path.iterdir())


def test_what_does_not_fit_is_told_in_one_line(run, folder: Path, tmp_path: Path) -> None:
    wide = tmp_path / "wide.zarr"
    assert run("explore", "furnished", "--views", 20, "--out", wide)[0] == 0
    refused(
        run("score", folder / "map", wide, "--train", folder / "walk.zarr"), "camera the map was learnt with"
    )
    refused(run("score", folder / "map", folder / "blind.zarr", "--train", folder / "walk.zarr"), "no poses")
    refused(run("explore", "pillar", "--views", 20, "--out", wide), "another recording")
    refused(run("learn", folder / "walk.zarr", "--out", folder / "map"), "exists already")
    refused(run("learn", folder / "blind.zarr", "--charts", 5000, "--out", tmp_path / "map"), "5000 charts")
    refused(run("demo", "--views", 100, "--out", folder), "not the result")
    assert np.asarray(Recording.open(wide).views[:]).shape == (20, 60, 360, 3)


@pytest.mark.usefixtures("few_words")
def test_an_experiment_leaves_its_metrics(run, tmp_path: Path) -> None:
    out = tmp_path / "spin"
    status, said, _ = run("experiment", "rotation", "--views", 200, "--seed", 1, "--out", out, "--json")
    assert status == 0
    assert json.loads(said) == json.loads((out / "metrics.json").read_text(encoding="utf-8"))
    assert {"views.png", "views.parquet"} <= {file.name for file in out.iterdir()}
    assert json.loads(run("report", out, "--json")[1]) == {"report": str(out / "report.html")}
    assert "--views 200 --seed 1" in (out / "report.html").read_text(encoding="utf-8")
    refused(run("report", tmp_path), "is not the result of")


@pytest.fixture(scope="module")
def settled(refined: Refined, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A refined map, its walk and a motor model."""
    place = tmp_path_factory.mktemp("settled")
    refined.walk.save(place / "walk.zarr")
    replace(refined.walk[:70], attributes={}).save(place / "anywhere.zarr")
    refined.cmap.save(place / "map")
    refined.motor.save(place / "motor")
    return place


def test_reach_goes_where_an_image_was_taken(run, settled: Path, tmp_path: Path) -> None:
    goal, size = tmp_path / "goal.png", ["--width", 90, "--height", 15]
    assert run("arena", "open_field", "--pose", -0.9, 0.4, 120, "--view", goal, *size)[0] == 0
    room, pose = Arena.load("open_field"), np.array([[-0.9, 0.4, np.deg2rad(120)]])
    seen = Camera.panoramic(90, 15).render(room, pose)[0]
    np.testing.assert_array_equal(cv2.imread(str(goal))[:, :, ::-1], seen)
    there = [settled / "map", settled / "walk.zarr", "--goal", goal]
    out = tmp_path / "reached"
    status, said, err = run("reach", *there, "--start", 0.8, -0.6, -90, "--out", out, "--json")
    assert status == 0, err
    found = json.loads(said)
    assert found == json.loads((out / "metrics.json").read_text(encoding="utf-8"))
    assert (found["outcome"], found["reason"], found["touched"]) == ("arrived", "", False)
    way = pd.read_parquet(out / "journey.parquet")
    np.testing.assert_allclose(way.iloc[0, 1:4], [0.8, -0.6, -np.pi / 2])
    np.testing.assert_allclose(way.iloc[-1, 1:4], pose[0], atol=0.03)
    assert found["seconds"] == way["time_s"].iloc[-1]
    assert way[["first_command", "second_command"]].abs().max().max() <= 1 + 1e-9
    assert np.hypot(1.7, 1.0) - 0.03 < found["way_m"] < 2.2
    assert (out / "journey.png").read_bytes().startswith(b"\x89PNG")
    status, said, _ = run("reach", *there, "--motor", out / "motor", "--seed", 3, "--out", tmp_path / "again")
    assert status == 0
    assert "arrived" in said
    assert not (tmp_path / "again" / "motor").exists()


def test_reach_refuses_bad_goals_before_anything_moves(
    run, settled: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def moved(*_: object, **__: object) -> None:
        pytest.fail("something moved")

    monkeypatch.setattr(acting, "babble", moved)
    monkeypatch.setattr(acting, "travel", moved)
    for name, size in (("black", (15, 90, 3)), ("large", (60, 360, 3))):
        cv2.imwrite(str(tmp_path / f"{name}.png"), np.zeros(size, np.uint8))
    (tmp_path / "text.png").write_text("no image", encoding="utf-8")
    known, out = (settled / "map", settled / "walk.zarr"), tmp_path / "out"
    for goal, words in (
        ("black", ["nothing that this map remembers"]),
        ("large", ["60×360", "15×90"]),
        ("text", ["no image"]),
        ("none", ["no image"]),
    ):
        refused(run("reach", *known, "--goal", tmp_path / f"{goal}.png", "--out", out), *words)
    black = ["--goal", tmp_path / "black.png", "--out", out]
    refused(run("reach", settled / "map", settled / "anywhere.zarr", *black), "which room")
    refused(run("reach", *known, *black, "--start", 9, 9, 0), "start")
    refused(run("reach", *known, *black, "--motor", settled / "map"), "motor")
    assert not out.exists()
    refused(run("arena", "pillar", "--view", out), "--pose")


def test_dream_films_the_way_from_one_view_to_another(
    run, settled: Path, tmp_path: Path, refined: Refined, monkeypatch: pytest.MonkeyPatch
) -> None:
    refined.walk[:300].save(tmp_path / "some.zarr")
    for name, view in (("a", 10), ("b", 13)):
        cv2.imwrite(str(tmp_path / f"{name}.png"), refined.walk.views[view][:, :, ::-1])
    ends = ["--from", tmp_path / "a.png", "--to", tmp_path / "b.png"]
    call = ["dream", settled / "map", tmp_path / "some.zarr", *ends, "--json"]
    status, said, err = run(*call, "--out", tmp_path / "film.mp4")
    assert (status, err) == (0, "")
    film = cv2.VideoCapture(str(tmp_path / "film.mp4"))
    found = json.loads(said)
    assert found["frames"] == film.get(cv2.CAP_PROP_FRAME_COUNT) > 5
    assert found["spread"] > 0
    refused(run(*call, "--out", tmp_path / "film.mp4"), "exists already")
    # a map that is not refined yet
    load = CognitiveMap.load

    def plain(path: Path) -> CognitiveMap:
        cmap = load(path)
        cmap.relaxed_places_ = None
        return cmap

    def refine(cmap: CognitiveMap, views: object) -> None:
        assert np.array_equal(np.asarray(views), refined.walk.views[:300])
        cmap.relaxed_places_ = refined.cmap.relaxed_places_

    monkeypatch.setattr(CognitiveMap, "load", plain)
    monkeypatch.setattr(CognitiveMap, "refine", refine)
    status, _, err = run(*call, "--out", tmp_path / "film")
    assert status == 0
    assert "not refined yet" in err
    assert len(list((tmp_path / "film").glob("*.png"))) == found["frames"]


def test_dream_refuses_bad_ends_and_leaves_nothing(
    run, settled: Path, tmp_path: Path, refined: Refined
) -> None:
    away = Camera.panoramic(90, 15).render(Arena.load("two_rooms"), np.array([[1.0, 0.3, 0.5]]))[0]
    images = {
        "here": refined.walk.views[10],
        "black": np.zeros((15, 90, 3), np.uint8),
        "large": np.zeros((60, 360, 3), np.uint8),
        "away": away,
    }
    for name, image in images.items():
        cv2.imwrite(str(tmp_path / f"{name}.png"), image[:, :, ::-1])
    out = tmp_path / "film.mp4"
    for goal, words in (
        ("black", ["view 1 is of one colour"]),
        ("large", ["60×360", "15×90"]),
        ("away", ["nothing that this map remembers"]),
        ("none", ["no image"]),
    ):
        ends = ["--from", tmp_path / "here.png", "--to", tmp_path / f"{goal}.png", "--out", out]
        refused(run("dream", settled / "map", settled / "walk.zarr", *ends), *words)
    ends = ["--from", tmp_path / "here.png", "--to", tmp_path / "here.png"]
    refused(run("dream", settled / "map", settled / "walk.zarr", *ends, "--out", tmp_path / "x.avi"), ".avi")
    assert {file.stem for file in tmp_path.iterdir()} == set(images)


def test_export_writes_nwb(run, folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "walk.nwb"
    status, said, err = run("export", folder / "walk.zarr", folder / "map", "--out", out, "--json")
    assert status == 0, err
    assert json.loads(said) == {"nwb": str(out), "views": 5000, "units": 210}
    refused(run("export", folder / "walk.zarr", folder / "map", "--out", out), "exists already")
    refused(run("export", folder / "blind.zarr", folder / "map", "--out", tmp_path / "x.nwb"), "no poses")


def test_help_gives_examples(run) -> None:
    said = run("experiment", "--help")[1]
    assert all(name in said for name in experiments())
    for command in (
        "demo",
        "experiment",
        "arena",
        "explore",
        "learn",
        "score",
        "report",
        "export",
        "reach",
        "dream",
    ):
        status, out, _ = run(command, "--help")
        assert status == 0
        assert f"cogmap {command} " in " ".join(out.split())


def test_a_tilde_is_the_home_in_every_path(run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "room.toml").write_text(FURNISHED, encoding="utf-8-sig")
    assert run("arena", "~/room.toml", "--out=~/room.png")[0] == 0
    assert (tmp_path / "room.png").is_file()
    refused(run("report", "~/nothing"), str(tmp_path / "nothing"))
    refused(run("learn", "~/nothing.zarr", "--out", "~nobody-of-this-name/map"), "home that is not known")


@pytest.mark.filterwarnings("ignore::cogmap.errors.UntrustedMapWarning")
def test_score_of_an_untrusted_map_says_so_whatever_python_is_told(run, folder: Path, tmp_path: Path) -> None:
    few = Recording.open(folder / "walk.zarr")[:300]
    few.save(tmp_path / "few.zarr")
    CognitiveMap(charts=60).fit(few.views, few.odours).save(tmp_path / "map")
    status, out, err = run(
        "score", tmp_path / "map", tmp_path / "few.zarr", "--train", tmp_path / "few.zarr", "--json"
    )
    assert status == 0
    assert json.loads(out)["trusted"] is False
    assert err == f"cogmap: this map is not to be trusted: {json.loads(out)['reason']}\n"
