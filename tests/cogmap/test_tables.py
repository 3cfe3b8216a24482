from pathlib import Path

import pandas as pd
import pytest

from cogmap.tables import as_markdown, as_table, write_table


@pytest.mark.parametrize(("ending", "read"), [("parquet", pd.read_parquet), ("csv", pd.read_csv)])
def test_a_table_is_read_back_as_it_was_written(tmp_path: Path, ending: str, read: object) -> None:
    table = pd.DataFrame({"view": [3, 5], "error_m": [0.1, 1 / 3]}, index=[7, 8])
    write_table(table, tmp_path / f"errors.{ending}")
    assert callable(read)
    pd.testing.assert_frame_equal(read(tmp_path / f"errors.{ending}"), table.reset_index(drop=True))


def test_every_figure_has_a_line_with_its_unit() -> None:
    table = as_table(
        {"heading_median_deg": 2.71828, "seconds": {"learn": 3.0}, "betti_place": [1, 0, 0], "reason": ""}
    )
    lines = [line.split() for line in table.splitlines()]
    assert ["heading_median_deg", "2.718", "°"] in lines
    assert ["seconds.learn", "3", "s"] in lines
    assert ["betti_place", "[1,", "0,", "0]"] in lines
    assert "reason" not in table


def test_markdown_has_a_row_for_each_record() -> None:
    rows = [{"name": "one", "size": "1"}, {"name": "two", "size": "2"}]
    assert as_markdown(rows).splitlines() == [
        "| name | size |", "| --- | --- |", "| one | 1 |", "| two | 2 |"
    ]  # fmt: skip
