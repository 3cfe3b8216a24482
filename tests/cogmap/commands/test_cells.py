import json
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from arena import Arena, Brownian, Camera, Recording, explore
from cogmap import CognitiveMap, cli
from cogmap.cells import MeasuredSession, session
from cogmap.evaluation.map_session import map_session
from tests.cogmap.rat import walk_and_fire


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    def call(*words: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["cogmap", *map(str, words)])
        status = 0
        try:
            cli.main()
        except SystemExit as stop:
            status = int(stop.code or 0)
        out, err = capsys.readouterr()
        return status, out, err

    return call


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A rat as tables, in centimetres; a small walk and a map of it."""
    place, rat = tmp_path_factory.mktemp("cells"), walk_and_fire()
    (place / "rat").mkdir()
    cells = np.repeat(np.arange(22), [len(train) for train in rat.trains])
    spikes = pd.DataFrame({"cell": cells, "t": np.concatenate(rat.trains)})
    spikes.to_csv(place / "rat" / "spikes.csv", index=False)
    x, y = 100 * rat.positions.T
    track = pd.DataFrame({"t": rat.times, "x": x, "y": y, "heading": rat.headings})
    track.to_csv(place / "rat" / "track.csv", index=False)
    track.drop(columns="heading").to_csv(place / "places.csv", index=False)
    walk = explore(Arena.load("open_field"), Brownian(), Camera.panoramic(90, 15), views=900, seed=0)
    walk.save(place / "walk.zarr")
    cmap = CognitiveMap(charts=200, components=20, place_cells=12, heading_cells=8)
    cmap.fit(walk.views, walk.odours).save(place / "map")
    return place


@pytest.mark.filterwarnings("ignore::cogmap.errors.UntrustedMapWarning")
def test_an_animal_and_a_map_side_by_side(run, folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "both"
    sources = [folder / "rat", folder / "walk.zarr", "--map", folder / "map"]
    told = ["--set", "unit=cm", "--set", "slowest=.01", "--shuffles", 5, "--json"]
    status, said, err = run("cells", *sources, *told, "--out", out)
    assert status == 0, err
    metrics = json.loads(said)
    assert metrics == json.loads((out / "metrics.json").read_text(encoding="utf-8"))
    table = pd.read_parquet(out / "cells.parquet")
    pd.testing.assert_frame_equal(table, pd.read_csv(out / "cells.csv", dtype={"cell": str}))
    assert list(dict.fromkeys(table["session"])) == ["rat", "walk"]
    assert not table.columns.duplicated().any()
    rat = session(folder / "rat", unit="cm", slowest=0.01)
    walk = map_session(Recording.open(folder / "walk.zarr"), CognitiveMap.load(folder / "map"), slowest=0.01)
    for name, found in (("rat", rat), ("walk", walk)):
        mine = table[table["session"] == name].drop(columns="session").reset_index(drop=True)
        expected = MeasuredSession(found, shuffles=5).table
        pd.testing.assert_frame_equal(mine, expected, rtol=0, atol=1e-6)
        assert metrics["sessions"][name]["views"] == len(found)
        assert metrics["sessions"][name]["slow"] == found.notes["slow"]
    assert metrics["sessions"]["rat"]["populations"]["cells"]["place_cells_passing"] == 16 / 22
    assert metrics["sessions"]["rat"]["decoding"]["position_median_m"] < 0.15
    assert metrics["sessions"]["walk"]["trusted"] is False
    assert metrics["sessions"]["walk"]["reason"] in err
    beside = pd.read_parquet(out / "by_population.parquet").set_index("figure")
    assert list(beside) == ["rat, cells", "walk, place", "walk, heading"]
    assert beside.loc["cells"].tolist() == [22, 12, 8]
    captions = json.loads((out / "captions.json").read_text(encoding="utf-8"))
    drawn = {path.stem for path in out.glob("*.png")}
    assert drawn == captions.keys()
    assert {"cells", "examples", "decoding_rat", "rate_maps_rat_cells", "tuning_curves_walk_heading"} <= drawn
    assert run("report", out)[0] == 0
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "<h1>Cells</h1>" in page
    assert "walk, heading" in page
    assert all(caption in page for caption in captions.values())
    assert "--set unit=cm --set slowest=.01 --map" in page


def test_a_track_from_elsewhere_without_headings(run, folder: Path, tmp_path: Path) -> None:
    words = [folder / "rat" / "spikes.csv", "--track", folder / "places.csv", "--set", "unit=cm"]
    fine = ["--set", "bin=.05", "--set", "smoothing=.06", "--set", "window=1", "--shuffles", 2]
    status, _, err = run("cells", *words, *fine, "--out", tmp_path / "out")
    assert status == 0, err
    drawn = {path.stem for path in (tmp_path / "out").glob("*.png")}
    assert drawn == {"cells", "decoding", "rate_maps_cells"}
    metrics = json.loads((tmp_path / "out" / "metrics.json").read_text(encoding="utf-8"))
    figures = metrics["sessions"]["spikes"]["populations"]["cells"]
    assert figures["place_cells_passing"] == 16 / 22
    assert not any("heading" in name or "vector" in name for name in figures)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "there is no session"),
        (["rat"], "positions span 9"),
        (["rat", "--set", "unt=cm"], "did you mean 'unit'"),
        (["rat", "--set", "unit=cm", "--set", "bin=0"], "bin is 0"),
        (["rat", "--set", "unit=cm", "--set", "slowest=fast"], "slowest is 'fast'"),
        (["rat", "--set", "unit=cm", "--shuffles", 0], "shuffles is 0"),
        (["walk.zarr"], "is a recording, which has no cells; give the map"),
        (["nowhere"], "nowhere"),
        (["nowhere.nwb"], "there is no such file"),
    ],
)
def test_bad_words_are_told_in_one_line(run, folder: Path, tmp_path: Path, words: list, said: str) -> None:
    first = [folder / words[0], *words[1:]] if words else []
    status, out, err = run("cells", *first, "--out", tmp_path / "out")
    assert (status, out) == (2, "")
    assert err.startswith("cogmap: ")
    assert len(err.splitlines()) == 1
    assert said in err
    assert not list(tmp_path.iterdir())
