from cogmap.tables import as_markdown, as_table


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
