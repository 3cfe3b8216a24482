from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import torch

from arena.errors import ArenaError
from arena.recordings.tables import table_of, times_of

FRAME = pd.DataFrame({"t": [0.5, 1.0, 2.5], "ap 1": [-40.5, -41.0, -42.25], "ap2": [1.0, 2.0, 3.0]})


def check(found: Any) -> None:
    np.testing.assert_array_equal(found.times, FRAME["t"])
    assert list(found.columns) == ["ap 1", "ap2"]
    for name in ("ap 1", "ap2"):
        np.testing.assert_array_equal(found.columns[name], FRAME[name])
        assert found.columns[name].dtype == np.float64
    assert found.rows == 3


@pytest.mark.parametrize("separator", [",", ";", "\t", ", "])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_csv_as_programs_write_it(tmp_path: Path, separator: str, encoding: str, end: str) -> None:
    lines = [separator.join(map(str, row)) for row in [FRAME.columns, *FRAME.to_numpy()]]
    path = tmp_path / "a.CSV"
    path.write_bytes((end.join(lines) + end).encode(encoding))
    check(table_of(path, "signals"))


@pytest.mark.parametrize("separator", [";", "\t"])
def test_decimal_commas(tmp_path: Path, separator: str) -> None:
    FRAME.to_csv(tmp_path / "a.csv", sep=separator, decimal=",", index=False)
    check(table_of(tmp_path / "a.csv", "signals"))


def test_parquet_frames_mappings_and_the_rows_that_pandas_counts(tmp_path: Path) -> None:
    FRAME.to_parquet(tmp_path / "a.parquet")
    FRAME.to_csv(tmp_path / "counted.csv")
    for source in (
        tmp_path / "a.parquet",
        str(tmp_path / "counted.csv"),
        FRAME,
        dict(FRAME),
        FRAME.convert_dtypes(),
    ):
        check(table_of(source, "signals"))
    tensors = {name: torch.tensor(FRAME[name].to_numpy()) for name in FRAME}
    check(table_of(tensors, "signals"))


def test_arrays_have_numbered_columns_or_names() -> None:
    values = np.arange(6.0).reshape(3, 2)
    assert list(table_of(values, "signals").columns) == ["column_1", "column_2"]
    assert list(table_of(values.tolist(), "poses", names=("x", "y")).columns) == ["x", "y"]
    assert list(table_of(values[:, 0], "signals").columns) == ["column_1"]


def test_missing_values_and_columns_that_are_not_wanted(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("Time,ssid,a,b\n0,x,1,\n1,y,NaN,2\n2,,n/a,3\n")
    table = table_of(tmp_path / "a.csv", "signals", ["b", "a"], needed=["b", "a"])
    assert list(table.columns) == ["b", "a"]
    np.testing.assert_array_equal(table.columns["a"], [1, np.nan, np.nan])
    np.testing.assert_array_equal(table.columns["b"], [np.nan, 2, 3])
    np.testing.assert_array_equal(table.times, [0, 1, 2])
    with pytest.raises(
        ArenaError, match=r"a\.csv: ssid is 'x' in row 1; give numbers there, or say which columns"
    ):
        table_of(tmp_path / "a.csv", "signals")
    with pytest.raises(ArenaError, match=r"a\.csv has no column c; it has Time, ssid, a, b"):
        table_of(tmp_path / "a.csv", "signals", ["a", "c"], needed=["a", "c"])


@pytest.mark.parametrize(
    "content",
    ["t\n0\n0.5\n2\n", "0\n0.5\n2\n", "0,0\n0,5\n2,0\n".replace(",", "."), "frame;t\n1;0\n2;0,5\n3;2\n"],
)
def test_times(tmp_path: Path, content: str) -> None:
    (tmp_path / "t.csv").write_text(content)
    np.testing.assert_array_equal(times_of(tmp_path / "t.csv"), [0, 0.5, 2])


def test_times_in_memory() -> None:
    for times in ([0, 0.5, 2], np.array([0, 0.5, 2]), pd.Series([0, 0.5, 2]), torch.tensor([0, 0.5, 2])):
        np.testing.assert_array_equal(times_of(times), [0, 0.5, 2])


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", "cannot read .* give CSV with a line of names, or Parquet"),
        ("\n\n", "cannot read "),
        ("t,a\n", "has no rows"),
        ("0.5,1\n1,2\n", "has no line of names: it begins with 0.5, 1; add one"),
        ("t,a\n0,1,2\n", "cannot read "),
        ("t,a\n0,1\n1,2,3,4\n", "cannot read "),
        ("t,a\n0,1\n0,2\n", "the times do not increase in row 2, where 0 s follows 0 s; sort"),
        ("t,a\n0,1\n,2\n", "has 1 rows without a time"),
        ("t,a\n0,high\n", "a is 'high' in row 1; give numbers"),
        ("t,a\n2024-05-01,1\n", "t is '2024-05-01' in row 1"),
    ],
)
def test_tables_that_are_none(tmp_path: Path, content: str, words: str) -> None:
    (tmp_path / "a.csv").write_text(content)
    with pytest.raises(ArenaError, match=words) as error:
        table_of(tmp_path / "a.csv", "signals")
    assert len(str(error.value).splitlines()) == 1


@pytest.mark.parametrize("name", ["a.csv", "a.parquet"])
def test_junk_and_what_is_not_there(tmp_path: Path, name: str) -> None:
    with pytest.raises(ArenaError, match=f"cannot read .*{name}: No such file or directory"):
        table_of(tmp_path / name, "signals")
    (tmp_path / name).write_bytes(b"\x89PNG\xff\xfe\x00junk" * 9)
    with pytest.raises(ArenaError, match=f"cannot read .*{name}") as error:
        table_of(tmp_path / name, "signals")
    assert len(str(error.value).splitlines()) == 1


def test_two_columns_of_one_name() -> None:
    with pytest.raises(ArenaError, match="has two columns a; rename one of them"):
        table_of(pd.DataFrame([[1, 2]], columns=["a", " a"]), "signals")


def test_times_without_a_name() -> None:
    with pytest.raises(ArenaError, match="the table of times has columns a, b, none of them named t, time, "):
        times_of({"a": [1, 2], "b": [1, 2]})
    with pytest.raises(ArenaError, match="the table of times is no table"):
        times_of({"a": [1, 2], "b": [1, 2, 3]})
