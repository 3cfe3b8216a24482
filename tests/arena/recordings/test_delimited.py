import string
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from arena.errors import ArenaError
from arena.recordings.delimited import layout_of, read_delimited, to_numbers

NAMES = st.text(string.ascii_letters + "_äé°", min_size=1, max_size=6).filter(lambda name: name != "scorer")


def read(path: Path) -> dict[str, np.ndarray]:
    layout = layout_of(path)
    cells, rows = read_delimited(path, layout, layout.names)
    return to_numbers(path, cells, rows)


@settings(max_examples=40, deadline=None)
@given(
    names=st.lists(NAMES, min_size=2, max_size=4, unique=True),
    values=st.lists(st.lists(st.floats(-1e6, 1e6), min_size=4, max_size=4), min_size=1, max_size=5),
    delimiter=st.sampled_from([",", ";", "\t"]),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252"]),
    ways=st.sets(st.sampled_from(["decimal commas", "line feeds only", "delimiter at the end", "sep="])),
)
def test_whatever_a_spreadsheet_writes_is_read(
    names: list[str], values: list[list[float]], delimiter: str, encoding: str, ways: set[str]
) -> None:
    def cell(value: float) -> str:
        written = repr(value).replace(".", ",") if "decimal commas" in ways else repr(value)
        return f'"{written}"' if delimiter in written else written

    rows = [[cell(value) for value in row[: len(names)]] for row in values]
    lines = [delimiter.join(row) + delimiter * ("delimiter at the end" in ways) for row in rows]
    head = [f"sep={delimiter}"] * ("sep=" in ways and encoding == "utf-8") + [delimiter.join(names)]
    end = "\n" if "line feeds only" in ways else "\r\n"
    with TemporaryDirectory() as folder:
        path = Path(folder) / "table.csv"
        path.write_bytes(end.join([*head, *lines, ""]).encode(encoding))
        found = read(path)
    assert list(found) == names
    np.testing.assert_array_equal(list(found.values()), np.array(values).T[: len(names)])


def test_of_deeplabcut_the_lines_of_names_are_joined(tmp_path: Path) -> None:
    path = tmp_path / "dlc.csv"
    path.write_text(
        "scorer,net,net,net\nindividuals,rat1,rat1,rat1\nbodyparts,nose,nose,nose\ncoords,x,y,likelihood\n0,1,2,.9\n",
        encoding="utf-8",
    )
    assert layout_of(path).names == ("frame", "rat1.nose.x", "rat1.nose.y", "rat1.nose.likelihood")
    assert {name: float(values[0]) for name, values in read(path).items()} == {
        "frame": 0, "rat1.nose.x": 1, "rat1.nose.y": 2, "rat1.nose.likelihood": 0.9
    }  # fmt: skip


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("# t,x,y\n0,1,2\n", ("t", "x", "y")),
        ("#t\tx\n0\t1\n", ("t", "x")),
        ("\n\nt,x\n0,1\n", ("t", "x")),
        ("t;x, cm;y, cm\n0;1,5;2,5\n1;1,5;2,5\n", ("t", "x, cm", "y, cm")),
        ("t,x;px,y;px\n0,1,2\n0,1,2\n", ("t", "x;px", "y;px")),
        ('"t","x"\n0,1\n', ("t", "x")),
        ("x\n1\n", ("x",)),
        ("", ()),
    ],
)
def test_names(tmp_path: Path, text: str, names: tuple[str, ...]) -> None:
    (tmp_path / "a.csv").write_text(text, encoding="utf-8")
    assert layout_of(tmp_path / "a.csv").names == names


@pytest.mark.parametrize("word", ["", " ", "nan", "NaN", "NA", "n/a", "NULL", "None"])
def test_what_stands_for_no_number(tmp_path: Path, word: str) -> None:
    (tmp_path / "a.csv").write_text(f"x,y\n1,2\n{word},3\n", encoding="utf-8")
    np.testing.assert_array_equal(read(tmp_path / "a.csv")["x"], [1, np.nan])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("t;x\n0;1,5\n1;2.5\n", "commas, in x, and with points, in x"),
        ("t\tx\n0.5\t1,234\n", "commas, in x, and with points, in t"),
        ("t;x\n0;1.234,5\n", "commas"),
        ("t;x\n0;1,234,5\n", "row 2 has x = '1,234,5'"),
        ("sep=;\n\nt;x\n0;left\n", "row 4 has x = 'left'"),
        ("t,x\n0,1\n1,2,3\n", "row 3 has 3 cells, not 2"),
        ("t,x\n0,1\n1\n", "row 3 has 1 cells, not 2"),
    ],
)
def test_faults_are_told_where_they_are(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "a.csv").write_text(text, encoding="utf-8")
    with pytest.raises(ArenaError, match=said) as caught:
        read(tmp_path / "a.csv")
    assert "a.csv" in str(caught.value)
