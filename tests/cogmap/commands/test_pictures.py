import json
import sys
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import pytest

from arena import Recording
from cogmap import cli

FRAMES = np.random.default_rng(0).integers(0, 256, (20, 30, 60, 3), dtype=np.uint8)


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    def call(*words: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["cogmap", "import", *map(str, words)])
        try:
            cli.main()
        except SystemExit as stop:
            return int(stop.code or 0), *capsys.readouterr()
        return 0, *capsys.readouterr()

    return call


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Frames and tables in the current folder."""
    monkeypatch.chdir(tmp_path)
    Path("frames").mkdir()
    for number, frame in enumerate(FRAMES):
        cv2.imwrite(f"frames/{number}.png", frame[..., ::-1])
    pd.DataFrame({"t": np.arange(20) / 4}).to_csv("t.csv", index=False)
    wifi = {"time": [0, 2, 5], "ap1": [-40, -60, -60], "ap2": [-70, -50, -50], "note": list("abc")}
    pd.DataFrame(wifi).to_csv("wifi.csv", sep=";", index=False)
    poses = {"x": np.arange(20.0), "y": 0.5, "heading_deg": 90}
    pd.DataFrame(poses).to_parquet("poses.parquet")


def test_pictures_with_all_that_is_beside_them(run) -> None:
    words = ["frames", "--out", "rec.zarr", "--kind", "equirectangular", "--width", 30,
             "--height", 4, "--ahead", -90, "--times", "t.csv", "--signals", "wifi.csv", "--columns", "ap2",
             "ap1", "--log", "--poses", "poses.parquet", "--json"]  # fmt: skip
    status, out, err = run(*words)
    assert (status, err) == (0, "")
    assert json.loads(out) == {
        "recording": "rec.zarr", "views": 20, "height": 4, "width": 30, "seconds": 4.75, "odorants": 2,
        "poses": True,
    }  # fmt: skip
    rec = Recording.open("rec.zarr")
    wanted = Recording.from_images(FRAMES, kind="equirectangular", width=30, height=4, ahead=-90)
    np.testing.assert_array_equal(rec.views[:], wanted.views)
    np.testing.assert_allclose(rec.signals["ap1"][[0, 4, 8, 19]], [-40, -50, -60, -60])
    odours = np.stack([rec.signals["ap2"], rec.signals["ap1"]], axis=1)
    np.testing.assert_allclose(rec.odours, 10 ** (odours / 10), rtol=1e-6)
    np.testing.assert_allclose(rec.poses[3], [3, 0.5, np.pi / 2])
    assert run(*words)[:2] == (0, out)


def test_a_video_and_a_mirror_as_a_table(run) -> None:
    writer = cv2.VideoWriter("film.avi", cv2.VideoWriter_fourcc(*"FFV1"), 5, (60, 30))
    for frame in FRAMES:
        writer.write(frame[..., ::-1])
    writer.release()
    status, out, _ = run("film.avi", "--out", "film.zarr")
    assert status == 0
    assert [line.split() for line in out.splitlines() if "seconds" in line] == [["seconds", "3.8", "s"]]
    np.testing.assert_array_equal(Recording.open("film.zarr").views[:], FRAMES)
    mirror = ["--kind", "mirror", "--mirror", 30, 15, 5, 14.5, "--no-clockwise", "--rate", 10]
    assert run("film.avi", "--out", "ring.zarr", *mirror)[0] == 0
    assert Recording.open("ring.zarr").views.shape == (20, 10, 61, 3)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nowhere"], "there is nothing at nowhere"),
        (["t.csv"], "t.csv is no video that can be read"),
        (
            ["frames", "--signals", "wifi.csv", "--columns", "ap1", "--times", "t.csv"],
            "ap1 is -40 at picture 0; ",
        ),
        (["frames", "--signals", "wifi.csv", "--times", "t.csv", "--log"], "note is 'a' in row 1"),
        (["frames", "--signals", "wifi.csv", "--columns", "ap1", "--log"], "has 3 rows for 20 pictures"),
        (["frames", "--poses", "t.csv"], "has no column x and no y and no heading"),
        (["frames", "--kind", "fisheye"], "fisheye"),
        (["frames", "--kind", "mirror"], "a mirror needs both"),
        (["frames", "--rate", 0], "the rate is 0"),
    ],
)
def test_bad_input_is_one_sentence(run, words: list[object], said: str) -> None:
    status, out, err = run(*words, "--out", "rec.zarr")
    assert (status, out) == (2, "")
    assert err.startswith("cogmap: ")
    assert said in err
    assert len(err.splitlines()) == 1
    assert not Path("rec.zarr").exists()
