from pathlib import Path

import numpy as np
import pytest

from arena.errors import ArenaError
from arena.motions.paths import read_joints, read_path

GOOD = "t,x,y\n0.0,1,2\n0.5,1.5,2\n1.0,2,2.5\n"


def write(folder: Path, text: str, name: str = "path.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_csv(tmp_path: Path) -> None:
    rows = ["\ufeffframe, y ,t,x,heading_deg", "0,2,0.0,1,90", "", "1,,0.5,1.5,nan", "2,2.5,1.0,NaN,"]
    text = "\r\n".join([*rows, "3,4,1.5,3,-180"])
    times, positions, headings = read_path(write(tmp_path, text))
    np.testing.assert_array_equal(times, [0, 0.5, 1, 1.5])
    np.testing.assert_array_equal(positions, [(1, 2), (1.5, np.nan), (np.nan, 2.5), (3, 4)])
    np.testing.assert_allclose(headings, [np.pi / 2, np.nan, np.nan, -np.pi])


def test_without_headings(tmp_path: Path) -> None:
    assert read_path(write(tmp_path, GOOD)).headings is None


@pytest.mark.parametrize("how", ["together", "apart"])
def test_npz_is_the_same(tmp_path: Path, how: str) -> None:
    rng = np.random.default_rng(0)
    times, positions, headings = np.arange(5), rng.random((5, 2)).astype(np.float32), rng.random(5)
    places = {"pos": positions} if how == "together" else {"x": positions[:, 0], "y": positions[:, 1]}
    np.savez(tmp_path / "path.npz", t=times, heading=headings, extra=np.array(["a"]), **places)
    found = read_path(tmp_path / "path.npz")
    np.testing.assert_array_equal(found.times, times)
    np.testing.assert_array_equal(found.positions, positions)
    np.testing.assert_array_equal(found.headings, headings)
    assert found.times.dtype == found.positions.dtype == np.float64


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "no column t and no x and no y"),
        ("\n\n", "no column t and no x and no y"),
        ("t,x\n0,1\n1,2\n", "no column y"),
        ("0.0,1,2\n0.5,1.5,2\n", "no column t"),
        ("t;x;y\n0;1;2\n", "no column t"),
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
    ],
)
def test_faults_of_a_csv_are_told_in_one_sentence(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ArenaError, match=said) as caught:
        read_path(write(tmp_path, text))
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
            read_path(path)
    np.savez(path, pos=np.zeros((4, 2)))
    with pytest.raises(ArenaError, match="no column t"):
        read_path(path)


@pytest.mark.parametrize("junk", [b"", b"PK\x03\x04 cut short", b"\x80\x04 pickled", b"\xff\xfe\x00"])
@pytest.mark.parametrize("name", ["path.csv", "path.npz"])
def test_junk_is_refused(tmp_path: Path, junk: bytes, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(junk)
    with pytest.raises(ArenaError, match=name):
        read_path(path)


def test_an_npz_cut_short_anywhere_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "path.npz"
    np.savez_compressed(path, t=np.arange(50), pos=np.random.default_rng(0).random((50, 2)))
    whole = path.read_bytes()
    for size in range(0, len(whole), 17):
        path.write_bytes(whole[:size])
        with pytest.raises(ArenaError, match="damaged"):
            read_path(path)
        path.write_bytes(whole[:size] + b"?" * 9 + whole[size + 9 :])
        try:
            read_path(path)
        except ArenaError as error:
            assert "path.npz" in str(error)  # noqa: PT017


def test_files_that_are_not_there_or_of_another_kind(tmp_path: Path) -> None:
    with pytest.raises(ArenaError, match="No such file"):
        read_path(tmp_path / "path.csv")
    with pytest.raises(ArenaError, match="No such file"):
        read_path(tmp_path / "path.npz")
    with pytest.raises(ArenaError, match=r"neither a \.csv nor a \.npz"):
        read_path(tmp_path / "path.mat")
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(ArenaError, match="directory"):
        read_path(tmp_path / "folder.csv")


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("0,1,2\n1,,3\n", "row 3 has joint_1 = nan"),
        ("0,1,2\n0,1,3\n", "do not increase at row 3"),
        ("0,1\n", "row 2 has 2 cells, not 3"),
    ],
)
def test_joints_are_whole_and_in_order(tmp_path: Path, rows: str, said: str) -> None:
    head = "t,joint_1,joint_2\n"
    times, joints = read_joints(write(tmp_path, head + "0,1,2\n1,-1,3\n"), ["joint_1", "joint_2"])
    assert (times.tolist(), joints.tolist()) == ([0, 1], [[1, 2], [-1, 3]])
    with pytest.raises(ArenaError, match=said):
        read_joints(write(tmp_path, head + rows), ["joint_1", "joint_2"])
