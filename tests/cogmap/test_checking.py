import json
import shutil
import sys
from collections.abc import Iterator
from importlib import resources
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from arena import Recording
from cogmap import CogmapError, CognitiveMap, Plan, check, cli
from cogmap.atomic import result_folder
from cogmap.experiments.provenance import write_provenance
from cogmap.experiments.result import Result
from cogmap.map.storage import write_state
from cogmap.sweeps.ledger import Ledger
from cogmap.sweeps.points import points_of

VIEWS = 300
PLAN = Plan.create(experiment="rotation", grid={"views": [200, 300]})


def spoil(file: Path, at: int) -> None:
    content = bytearray(file.read_bytes())
    content[at] ^= 1
    file.write_bytes(content)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One of everything."""
    place, rng = tmp_path_factory.mktemp("written"), np.random.default_rng(0)
    views = rng.integers(0, 256, (VIEWS, 15, 90, 3), dtype=np.uint8)
    odours = rng.uniform(0.1, 1, (VIEWS, 2)).astype(np.float32)
    Recording(views=views, times=np.arange(VIEWS) * 0.2, odours=odours).save(place / "walk.zarr")
    sizes = {"charts": 6, "components": 4, "place_cells": 4, "heading_cells": 4}
    CognitiveMap(**sizes).partial_fit(views[:20], odours[:20]).save(place / "map")
    with result_folder(place / "result") as folder:
        Result({"seconds": 1.0}, {"table": pd.DataFrame({"x": [1.0]})}).write(folder)
        write_provenance(folder, ("experiment", "rotation"), None, views=200)
    ledger, points = Ledger(place / "sweep"), points_of(PLAN)
    with ledger.opened(PLAN, points):
        for point in points:
            ledger.write(point, {"metrics": {"share": 0.5}, "arithmetic": "x"})
    shutil.copy(str(resources.files("arena") / "gallery" / "pillar.toml"), place / "room.toml")
    (place / "plan.toml").write_text(PLAN.to_toml(), encoding="utf-8")
    return place


@pytest.fixture
def place(written: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(written, tmp_path / "place"))


@pytest.mark.parametrize(
    ("name", "kind", "version", "parts"),
    [
        ("walk.zarr", "recording", 4, {"views": "300 of 300", "times": "300", "odours": "300×2"}),
        ("map", "map", 8, {"settings": "11", "learnt": "4"}),
        ("result", "result", None, {"files": "5 of 5"}),
        ("sweep", "sweep", 2, {"points": "2 of 2"}),
        ("room.toml", "room", None, {"name": "pillar", "walls": "4"}),
        ("plan.toml", "plan", None, {"experiment": "rotation"}),
    ],
)
def test_what_is_whole_is_told(
    written: Path, name: str, kind: str, version: int | None, parts: dict[str, str]
) -> None:
    found = check(str(written / name))
    assert (found.kind, found.version, found.damage, found.sentence) == (kind, version, (), "")
    assert found.whole
    assert parts.items() <= found.parts.items()


@pytest.mark.parametrize(
    ("file", "at", "said"),
    [
        ("walk.zarr/views/c/1/0/0/0", 100, "299 of 300 views are whole, and `--rescue` saves them"),
        ("walk.zarr/times/c/0", 3, "times cannot be read: .*; record it again"),
        ("walk.zarr/odours/c/0/0", 3, "odours cannot be read: .*; 300 of 300 views are whole"),
        ("map/weights.safetensors", -1, r"the weight [\w.]+ does not match its checksum; learn it again"),
        ("map/map.json", 60, "map is damaged"),
        ("result/metrics.json", 16, "'metrics.json' is not .*`cogmap experiment rotation --views 200` does"),
        ("result/table.csv", 0, "'table.csv' is not what was written"),
        ("result/SHA256SUMS", 3, "'about.json' is not what was written; do it again"),
        ("sweep/sweep.json", 90, "sweep.json is damaged; choose another folder"),
        ("room.toml", 0, "room.toml"),
        ("plan.toml", 0, "plan.toml"),
    ],
)
def test_what_is_damaged_and_what_can_be_saved_is_told(place: Path, file: str, at: int, said: str) -> None:
    spoil(place / file, at)
    found = check(place / file.split("/", maxsplit=1)[0])
    assert not found.whole
    with pytest.raises(CogmapError, match=said):
        raise CogmapError(found.sentence)
    assert len(found.sentence.splitlines()) == 1


def test_an_import_that_was_killed_is_half_written(tmp_path: Path) -> None:
    frames = np.random.default_rng(0).integers(0, 256, (300, 15, 90, 3), dtype=np.uint8)

    def killed() -> Iterator[np.ndarray]:
        yield from frames[:280]
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        Recording.from_images(killed(), out=tmp_path / "walk.zarr")
    found = check(tmp_path / "walk.zarr")
    assert (found.kind, found.whole, found.parts) == ("recording", False, {"views": "256"})
    assert found.sentence.endswith(
        "half-written: 256 views are there; the same `import` command goes on where it stopped"
    )
    Recording.from_images(iter(frames), out=tmp_path / "walk.zarr")
    assert check(tmp_path / "walk.zarr").whole


def test_points_of_a_sweep_are_those_of_their_names(place: Path) -> None:
    first, second = sorted((place / "sweep" / "points").iterdir())
    contents = first.read_bytes()
    first.write_bytes(second.read_bytes())
    second.write_bytes(contents)
    found = check(place / "sweep")
    assert found.parts == {"points": "0 of 2"}
    assert f"{first} is damaged; remove it and the same command does this point again" in found.sentence


def test_the_table_of_a_sweep_is_compared(place: Path) -> None:
    (place / "sweep" / "table.csv").write_text("seed\n0\n", encoding="utf-8")
    found = check(place / "sweep")
    assert found.parts == {"points": "2 of 2", "files": "0 of 1"}
    assert found.sentence.endswith("the same command writes the table and its figures again")


def test_points_of_a_sweep_that_are_lost(place: Path) -> None:
    next((place / "sweep" / "points").iterdir()).unlink()
    assert check(place / "sweep").sentence.endswith("sweep lacks points; the same command does them")


def test_a_sweep_of_an_older_layout_is_one_sentence(place: Path) -> None:
    (place / "sweep" / "sweep.json").write_text('{"format": "cogmap sweep 1"}', encoding="utf-8")
    assert "of the format 'cogmap sweep 1', not 'cogmap sweep 2'" in check(place / "sweep").sentence


def test_sums_that_say_nothing_of_the_metrics(place: Path) -> None:
    (place / "result" / "SHA256SUMS").write_text("", encoding="utf-8")
    assert "SHA256SUMS says nothing of metrics.json" in check(place / "result").sentence


@pytest.mark.parametrize("kind", ["map", "memory", "motor", "coordinates"])
def test_weights_that_are_no_whole_map_are_refused(tmp_path: Path, kind: str) -> None:
    write_state(tmp_path / "it", {}, {}, {}, kind=kind)
    found = check(tmp_path / "it")
    assert (found.kind, found.whole) == (kind, False)
    assert "does not hold" in found.sentence


def test_an_older_version_is_one_sentence(place: Path) -> None:
    for name, file in (("walk.zarr", "zarr.json"), ("map", "map.json")):
        described = json.loads((place / name / file).read_text("utf-8"))
        (described.get("attributes") or described)["version"] = 1
        (place / name / file).write_text(json.dumps(described), encoding="utf-8")
        assert "version 1, not" in check(place / name).sentence


@pytest.mark.parametrize("name", ["nothing", ".", "walk.zarr/views/c", "walk.zarr/times/c/0"])
def test_what_is_nothing_of_ours_is_refused(written: Path, name: str) -> None:
    with pytest.raises(CogmapError, match=r"there is nothing at|is nothing of ours"):
        check(written / name)


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]):
    def call(*words: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["cogmap", *map(str, words)])
        try:
            cli.main()
        except SystemExit as stop:
            return int(stop.code or 0), *capfd.readouterr()
        return 0, *capfd.readouterr()

    return call


def test_check_says_it_and_exits(run, place: Path) -> None:
    status, out, err = run("check", place / "walk.zarr", "--json")
    assert (status, err) == (0, "")
    assert json.loads(out)["parts"]["views"] == "300 of 300"
    spoil(place / "walk.zarr" / "views" / "c" / "1" / "0" / "0" / "0", 100)
    status, out, err = run("check", place / "walk.zarr", "--json")
    assert status == 2
    assert not json.loads(out)["whole"]
    assert len(err.splitlines()) == 1
    assert "299 of 300 views are whole, and `--rescue` saves them" in err


def test_check_rescues_what_is_whole(run, place: Path) -> None:
    spoil(place / "walk.zarr" / "views" / "c" / "0" / "0" / "0" / "0", -5)
    status, out, err = run("check", place / "walk.zarr", "--rescue", place / "rest.zarr", "--json")
    assert (status, err) == (0, "")
    assert json.loads(out)["rescued"] == {"recording": str(place / "rest.zarr"), "views": 44}
    rest, wanted = Recording.open(place / "rest.zarr"), np.arange(256, VIEWS) * 0.2
    np.testing.assert_array_equal(rest.times, wanted)
    for words in (("walk.zarr", "rest.zarr"), ("map", "new.zarr")):
        status, out, err = run("check", place / words[0], "--rescue", place / words[1])
        assert (status, out) == (2, "")
        assert "exists already" in err or "only recordings are rescued" in err


@pytest.mark.parametrize("name", ["views/c/0/0/0/0", "odours/c/0/0", "zarr.json"])
def test_learning_from_what_is_damaged_is_one_sentence(run, place: Path, name: str) -> None:
    spoil(place / "walk.zarr" / name, 40)
    status, out, err = run("learn", place / "walk.zarr", "--out", place / "grown")
    assert (status, out) == (2, "")
    assert len(err.splitlines()) == 1
    assert not (place / "grown").exists()
