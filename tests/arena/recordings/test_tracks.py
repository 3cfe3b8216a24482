import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from arena import ArenaError, RecordedPath, TrackWarning, read_track

GOOD = "t,x,y\n0.0,1,2\n0.5,1.5,2\n1.0,2,2.5\n"
DLC = "scorer,net,net,net,net,net,net\nbodyparts,nose,nose,nose,body,body,body\n"
DLC += "coords,x,y,likelihood,x,y,likelihood\n"


def write(folder: Path, text: str, name: str = "path.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def rat(count: int = 600, rate: float = 25.0) -> dict[str, np.ndarray]:
    """A path in pixels, and where it looks."""
    t = np.arange(count) / rate
    x, y = 300 + 200 * np.sin(t), 200 + 150 * np.sin(1.37 * t)
    return {"t": t, "x": x, "y": y, "heading": np.arctan2(np.gradient(y), np.gradient(x))}


def saved(folder: Path, **columns: np.ndarray) -> Path:
    path = folder / "path.csv"
    pd.DataFrame(columns).to_csv(path, index=False)
    return path


def test_csv(tmp_path: Path) -> None:
    rows = ["\ufeffframe, y ,t,x,heading_deg", "0,2,0.0,1,90", "", "1,,0.5,1.5,nan", "2,2.5,1.0,NaN,"]
    text = "\r\n".join([*rows, "3,4,1.5,3,-180"])
    times, positions, headings, notes, doubtful = read_track(write(tmp_path, text))
    np.testing.assert_array_equal(times, [0, 0.5, 1, 1.5])
    np.testing.assert_array_equal(positions, [(1, 2), (1.5, np.nan), (np.nan, 2.5), (3, 4)])
    np.testing.assert_allclose(headings, [np.pi / 2, np.nan, np.nan, -np.pi])
    assert notes == {"blank": 2}
    assert not doubtful.any()


def test_without_headings(tmp_path: Path) -> None:
    found = read_track(str(write(tmp_path, GOOD)))
    assert found.headings is None
    assert found.notes == {}


@pytest.mark.parametrize("how", ["together", "apart"])
def test_npz_is_the_same(tmp_path: Path, how: str) -> None:
    rng = np.random.default_rng(0)
    times, positions, headings = np.arange(5), rng.random((5, 2)).astype(np.float32), rng.random(5)
    places = {"pos": positions} if how == "together" else {"x": positions[:, 0], "y": positions[:, 1]}
    np.savez(tmp_path / "path.npz", t=times, heading=headings, extra=np.array(["a"]), **places)
    found = read_track(tmp_path / "path.npz")
    np.testing.assert_array_equal(found.times, times)
    np.testing.assert_array_equal(found.positions, positions)
    np.testing.assert_array_equal(found.headings, headings)
    assert found.times.dtype == found.positions.dtype == np.float64


@pytest.mark.parametrize("name", ["p.csv", "p.CSV", "p.txt", "p.TSV", "p.parquet", "p.pq", "p.npz"])
def test_every_kind_of_file_is_the_same(tmp_path: Path, name: str) -> None:
    columns = {"Time": rat(50)["t"], "nose_x": rat(50)["x"], "nose_y": rat(50)["y"]}
    columns["nose_x"][7] = np.nan
    table, path = pd.DataFrame(columns), tmp_path / name
    if name.endswith("npz"):
        np.savez(path, **columns)
    elif name.endswith((".parquet", ".pq")):
        table.assign(word="a").to_parquet(path, index=False)
    else:
        table.to_csv(path, index=False, sep="\t" if "T" in name else ";", decimal=",")
    found = read_track(path, x="nose_x", y="nose_y")
    np.testing.assert_array_equal(found.times, columns["Time"])
    np.testing.assert_array_equal(found.positions[:, 0], columns["nose_x"])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "no column t and no x and no y"),
        ("\n\n", "no column t and no x and no y"),
        ("t,x\n0,1\n1,2\n", "no column y; it has t, x; pass x= and y="),
        ("0.0,1,2\n0.5,1.5,2\n", "no column t.*numbers where names must be"),
        ("t;x;y\n0;1;2\n", "1 positions"),
        ("t,x,y\n", "0 positions"),
        ("t,x,y\n0,1,2\n", "1 position"),
        ("t,x,y\n0,nan,2\n1,,nan\n2,nan,nan\n", "0 positions"),
        ("t,x,y\n0,1,2\n1,nan,2\n", "1 position"),
        (GOOD + "1.5,lost,3\n", "row 5 has x = 'lost'"),
        (GOOD + "1.5,3\n", "row 5 has 2 cells, not 3"),
        (GOOD + "1.5,3,4,5\n", "row 5 has 4 cells, not 3"),
        (GOOD + "\n1.0,3,4\n", "do not increase at row 6, where 1 s follows 1 s"),
        (GOOD + "0.9,3,4\n", "do not increase at row 5"),
        (GOOD + "nan,3,4\n", "row 5 has t = nan"),
        (GOOD + ",3,4\n", "row 5 has t = nan"),
        (GOOD + "1.5,inf,4\n", "row 5 has x = inf"),
        ("t,x,y,heading\n0,1,2,\n1,2,3,nan\n", "heading column without a number"),
        ("t,x,y,heading,heading_deg\n0,1,2,1,1\n1,2,3,1,1\n", "both heading and heading_deg"),
        ('t,x,y\n0,1,"2\n', "damaged"),
        ("t,x,y,x\n0,1,2,3\n", "more than one column x"),
        ("zeit,nase_x,nase_y\n0,1,2\n", r"it has zeit, nase_x, nase_y; pass x= and y=, .* and t="),
    ],
)
def test_faults_of_a_csv_are_told_in_one_sentence(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ArenaError, match=said) as caught:
        read_track(write(tmp_path, text))
    assert "path.csv" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_faults_of_an_npz(tmp_path: Path) -> None:
    path = tmp_path / "path.npz"
    good = {"t": np.arange(4.0), "pos": np.zeros((4, 2))}
    for wrong, said in (
        ({"pos": np.zeros((4, 3))}, r"pos has shape \(4, 3\)"),
        ({"pos": np.zeros((5, 2))}, "differ in length"),
        ({"t": np.array(["a"] * 4)}, "rows of numbers"),
        ({"t": np.zeros((4, 1))}, "rows of numbers"),
        ({"t": np.arange(4)[::-1]}, "do not increase at row 1"),
        ({"heading": np.full(4, np.nan)}, "heading column without a number"),
        ({"t": np.array([{}] * 4)}, "Python objects"),
    ):
        np.savez(path, **{**good, **wrong})
        with pytest.raises(ArenaError, match=said):
            read_track(path)
    np.savez(path, pos=np.zeros((4, 2)))
    with pytest.raises(ArenaError, match="no column t"):
        read_track(path)


@pytest.mark.parametrize("junk", [b"", b"PK\x03\x04 cut short", b"\x80\x04 pickled", b"\xff\xfe\x00"])
@pytest.mark.parametrize("name", ["path.csv", "path.npz", "path.parquet"])
def test_junk_is_refused(tmp_path: Path, junk: bytes, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(junk)
    with pytest.raises(ArenaError, match=name) as caught:
        read_track(path)
    assert str(caught.value).isprintable()


@pytest.mark.parametrize("name", ["path.npz", "path.parquet"])
def test_a_file_cut_short_anywhere_is_refused(tmp_path: Path, name: str) -> None:
    path, rng = tmp_path / name, np.random.default_rng(0)
    columns = {"t": np.arange(50) / 7, "x": rng.random(50), "y": rng.random(50)}
    if name.endswith("npz"):
        np.savez_compressed(path, **columns)
    else:
        pd.DataFrame(columns).to_parquet(path, index=False)
    whole = path.read_bytes()
    for size in range(0, len(whole), max(17, len(whole) // 60)):
        path.write_bytes(whole[:size])
        with pytest.raises(ArenaError, match=r"damaged|cannot read"):
            read_track(path)
        path.write_bytes(whole[:size] + b"?" * 9 + whole[size + 9 :])
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", TrackWarning)
                read_track(path)
        except ArenaError as error:
            assert name in str(error)  # noqa: PT017


def test_files_that_are_not_there_or_of_another_kind(tmp_path: Path) -> None:
    for name in ("path.csv", "path.npz", "path.parquet"):
        with pytest.raises(ArenaError, match="No such file"):
            read_track(tmp_path / name)
    with pytest.raises(ArenaError, match=r"neither a \.csv nor a \.npz"):
        read_track(tmp_path / "path.mat")
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(ArenaError, match="directory"):
        read_track(tmp_path / "folder.csv")
    with pytest.raises(ArenaError, match="frames_per_second"):
        read_track(write(tmp_path, GOOD), frames_per_second=3)


@pytest.fixture
def deeplabcut(tmp_path: Path) -> Path:
    path = rat()
    rows = (
        f"{k},{x},{y},{0.2 if k % 100 == 9 else 0.99},{x - 9},{y},.99\n"
        for k, (x, y) in enumerate(zip(path["x"], path["y"], strict=True))
    )
    return write(tmp_path, DLC + "".join(rows), "dlc.csv")


def test_deeplabcut(deeplabcut: Path) -> None:
    found = read_track(deeplabcut, bodypart="nose", rate=25, least_likelihood=0.9)
    lost = np.arange(600) % 100 == 9
    np.testing.assert_allclose(found.times, rat()["t"])
    np.testing.assert_array_equal(found.positions[~lost], np.stack([rat()["x"], rat()["y"]], axis=1)[~lost])
    assert np.isnan(found.positions[lost]).all()
    assert found.notes == {"unlikely": 6, "rate": 25.0}
    np.testing.assert_array_equal(
        read_track(deeplabcut, bodypart="body", rate=25).positions[:, 0], rat()["x"] - 9
    )


def test_each_lost_sample_is_counted_once(tmp_path: Path) -> None:
    columns = {**rat(), "p": np.ones(600)}
    columns["x"][[5, 6]] = columns["y"][[5, 6]] = 1023
    columns["x"][[8, 9]] = np.nan
    columns["p"][[6, 9, 12]] = 0.1, np.nan, np.nan
    found = read_track(saved(tmp_path, **columns), likelihood="p", least_likelihood=0.5, missing=1023)
    assert found.notes == {"blank": 2, "missing": 2, "unlikely": 1}
    assert np.flatnonzero(np.isnan(found.positions[:, 0])).tolist() == [5, 6, 8, 9, 12]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (
            {},
            r"no column t and no x.*it has frame, nose\.x.*='nose' \(or another of nose, body\) and rate=",
        ),
        ({"rate": 25}, r"no column x and no y.*pass bodypart='nose'"),
        ({"bodypart": "nose"}, "no column t; .*pass rate="),
        ({"bodypart": "tail", "rate": 25}, "no body part 'tail'; its body parts are nose, body"),
        ({"x": "nose.x", "y": "nose.z", "rate": 25}, r"no column nose\.z; it has frame, nose\.x"),
        ({"x": "nose.x", "y": "nose.y", "rate": 25, "least_likelihood": 0.5}, "no likelihood of x and y"),
        ({"bodypart": "nose", "rate": 25, "least_likelihood": 1.0}, r"0 positions.*\(600 unlikely\)"),
        ({"bodypart": "nose", "rate": 25, "individual": "a"}, "no column track"),
    ],
)
def test_what_to_pass_is_told(deeplabcut: Path, options: dict[str, object], said: str) -> None:
    with pytest.raises(ArenaError, match=said):
        read_track(deeplabcut, **options)


def test_sleap(tmp_path: Path) -> None:
    rows = ["track,frame_idx,instance.score,nose.x,nose.y,nose.score"]
    for frame in range(40):
        rows += [
            f"track_{k},{frame},0.9,{10 * k + frame},{frame},{0.1 if frame == 3 else 0.8}" for k in range(2)
        ]
    del rows[9]
    path = write(tmp_path, "\n".join(rows))
    with pytest.raises(ArenaError, match="track_0, track_1; choose one: individual='track_0'"):
        read_track(path, rate=20)
    with pytest.raises(ArenaError, match="no track 'rat'; it has track_0, track_1"):
        read_track(path, rate=20, individual="rat")
    found = read_track(path, rate=20, individual="track_1", least_likelihood=0.5)
    np.testing.assert_allclose(found.times, np.arange(40) / 20)
    np.testing.assert_array_equal(found.positions[5:, 0], np.arange(15, 50))
    assert np.flatnonzero(np.isnan(found.positions[:, 0])).tolist() == [3]
    assert len(read_track(path, rate=20, individual="track_0").times) == 39


@pytest.mark.parametrize("counted", [np.arange(600), np.arange(600) * 40])
def test_times_that_count_something_else_are_noticed(tmp_path: Path, counted: np.ndarray) -> None:
    path = saved(tmp_path, **{**rat(), "t": counted})
    with pytest.raises(ArenaError, match="does not count seconds; pass rate="):
        read_track(path)
    rate = 25 * counted[1]
    np.testing.assert_allclose(read_track(path, rate=rate).times, rat()["t"])
    np.testing.assert_allclose(read_track(path, rate=1).times, counted)


def test_a_rate_is_of_frames(tmp_path: Path) -> None:
    columns = rat(60)
    only = {name: columns[name] for name in "xy"}
    np.testing.assert_allclose(read_track(saved(tmp_path, **only), rate=25).times, columns["t"])
    with pytest.raises(ArenaError, match=r"t has fractions, such as 0.04, and counts no frames"):
        read_track(saved(tmp_path, **columns), rate=25)
    np.testing.assert_allclose(
        read_track(saved(tmp_path, **columns), t="t", rate=10).times, columns["t"] / 10
    )
    frames = 3 + np.arange(60)
    found = read_track(saved(tmp_path, Frame=frames, **columns), rate=25)
    np.testing.assert_allclose(found.times, frames / 25)


def test_once_a_second_is_believed_when_the_animal_moves_on(tmp_path: Path) -> None:
    walk = np.random.default_rng(0).uniform(0, 1, (100, 2))
    found = read_track(saved(tmp_path, t=np.arange(100), x=walk[:, 0], y=walk[:, 1]))
    np.testing.assert_array_equal(found.times, np.arange(100))


def test_units_become_metres(tmp_path: Path) -> None:
    columns = rat()
    path = saved(tmp_path, **columns)
    plain = read_track(path, scale=0.002)
    np.testing.assert_allclose(plain.positions, 0.002 * np.stack([columns["x"], columns["y"]], axis=1))
    assert plain.notes == {"metres_per_unit": [0.002, 0.002]}
    np.testing.assert_array_equal(plain.headings, columns["heading"])
    two_points = read_track(path, calibration=((100, 100), (400, 500), 1.0))
    np.testing.assert_allclose(two_points.positions, plain.positions)
    down = read_track(path, scale=0.002, y_down=True)
    np.testing.assert_allclose(down.positions, plain.positions * [1, -1])
    # It looks where it goes, whatever the pixels are.
    for options in ({}, {"scale": (0.002, 0.003)}, {"scale": (0.003, 0.002), "y_down": True}):
        assert looks_ahead(read_track(path, **options)) < 1e-6, options


def looks_ahead(found: RecordedPath) -> float:
    x, y = np.gradient(found.positions, axis=0).T
    assert found.headings is not None
    return float(np.abs(np.angle(np.exp(1j * found.headings) / (x + 1j * y))).max())


def test_what_is_missing_is_told_and_nothing_else_is(tmp_path: Path) -> None:
    columns = rat()
    for at, value in ((3, 0), (50, -1), (90, 1023), (200, 0)):
        columns["x"][at] = columns["y"][at] = value
    columns["x"][400] = 0
    path = saved(tmp_path, **columns)
    found = read_track(path, missing=[0, -1, np.nan, 1023], fastest=3, scale=0.002)
    assert np.flatnonzero(np.isnan(found.positions[:, 0])).tolist() == [3, 50, 90, 200, 400]
    assert np.flatnonzero(np.isnan(found.headings)).tolist() == [3, 50, 90, 200, 400]
    assert found.notes == {"missing": 4, "too_fast": 1, "metres_per_unit": [0.002, 0.002]}
    with pytest.warns(TrackWarning, match=r"2 of 600 samples are exactly \(0, 0\).* 3 more.*missing=0 if so"):
        undeclared = read_track(path)
    assert np.isfinite(undeclared.positions).all()
    assert undeclared.notes == {"doubtful": 5}
    assert np.flatnonzero(undeclared.doubtful).tolist() == [3, 50, 90, 200, 400]
    with pytest.warns(TrackWarning, match="1 of 600 samples jump off and back.*fastest="):
        assert read_track(path, missing=(0, -1, 1023)).notes["doubtful"] == 1


def test_a_missing_number_that_is_no_angle_is_a_missing_heading(tmp_path: Path) -> None:
    columns = rat()
    columns["heading"][[5, 6]] = 999, 0
    path = saved(tmp_path, **columns)
    with pytest.raises(ArenaError, match="missing="):
        read_track(path)
    assert np.flatnonzero(np.isnan(read_track(path, missing=(999, 0)).headings)).tolist() == [5]
    degrees = saved(tmp_path, **{**columns, "heading": np.rad2deg(columns["heading"])})
    np.testing.assert_allclose(read_track(degrees, heading_in="deg").headings, columns["heading"])


def test_a_pair_is_told_as_a_pair(tmp_path: Path) -> None:
    columns = rat()
    columns["x"][[9, 80]], columns["y"][[9, 80]] = 1023, 767
    path = saved(tmp_path, **columns)
    with pytest.warns(TrackWarning, match=r"pass missing=\(\(1023, 767\),\) if so"):
        read_track(path)
    assert read_track(path, missing=((1023, 767),)).notes["missing"] == 2


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"bodypart": "nose", "x": "a", "y": "b"}, "bodypart names the columns"),
        ({"x": "a"}, "only one of x and y"),
        ({"scale": 2.0, "calibration": ((0, 0), (1, 1), 1.0)}, "choose one"),
        ({"calibration": ((1, 1), (1, 1), 1.0)}, "two points of calibration are one"),
        ({"scale": 0}, "scale"),
        ({"scale": (1, 2, 3)}, "scale"),
        ({"rate": np.inf}, "rate"),
        ({"missing": "lost"}, "missing"),
        ({"least_likelihood": 2}, "least_likelihood"),
        ({"heading_in": "grad"}, "heading_in"),
    ],
)
def test_options_that_cannot_be_are_refused(tmp_path: Path, options: dict[str, object], said: str) -> None:
    with pytest.raises(ArenaError, match=said):
        read_track(write(tmp_path, GOOD), **options)
