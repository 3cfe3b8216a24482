from typing import Any

import pandas as pd

from cogmap import Plan
from cogmap.sweeps.points import points_of
from cogmap.sweeps.table import comparable, table_of


def test_nested_metrics_become_one_row_without_what_the_machine_does() -> None:
    nested = {
        "a": 1,
        "b": {"c": 2.5, "d": [1, {"e": None}], "seconds": 9},
        "seconds": {"all": 3},
        "learn_seconds": {"x": 1},
        "query_ms": 2,
        "peak_memory_bytes": 3,
        "host": "here",
        "atoms": 7,
    }
    assert comparable(nested) == {"a": 1, "b.c": 2.5, "b.d.0": 1, "b.d.1.e": None, "atoms": 7}


def tabled(*metrics: dict[str, Any], **grid: list[Any]) -> pd.DataFrame:
    plan = Plan.create(experiment="toy", seeds=[1, 0], grid=grid or {"nose.noise": [0.2, 0.1]})
    points = points_of(plan)
    given = [*metrics, *[{"metrics": {}}] * (len(points) - len(metrics))]
    return table_of(points, given)


def test_rows_are_sorted_and_columns_have_one_type() -> None:
    table = tabled(
        {"metrics": {"n": 1, "x": 1, "flag": True, "word": "a", "mixed": 1}},
        {"metrics": {"n": 2, "x": 0.5, "flag": False, "word": None, "mixed": "b"}},
        {"error": "RuntimeError: no"},
        {"metrics": {"n": 4, "x": float("nan"), "flag": None, "mixed": True}},
    )
    assert list(table.columns) == [
        "experiment", "arena", "views", "nose.noise", "seed", "n", "x", "flag", "word", "mixed",
        "trusted", "reason", "error",
    ]  # fmt: skip
    assert table[["nose.noise", "seed"]].to_numpy().tolist() == [[0.1, 0], [0.1, 1], [0.2, 0], [0.2, 1]]
    assert table["error"].tolist() == ["", "RuntimeError: no", "", ""]
    assert table["n"].isna().tolist() == [False, True, False, False]
    assert table["mixed"].tolist()[::2] == ["True", "b"]
    assert [str(table[name].dtype) for name in ("x", "flag", "seed")] == ["float64", "boolean", "int64"]
    assert set(table["arena"]) == {"furnished"}


def test_a_map_that_is_not_trusted_says_so() -> None:
    table = tabled(
        {"metrics": {"trusted": True, "reason": ""}},
        {"metrics": {"trusted": False, "reason": "too few charts"}},
        {"metrics": {"fused.trusted": False, "other.trusted": True}},
    ).sort_values(["nose.noise", "seed"], ascending=False)
    assert table["trusted"].tolist() == [True, False, False, pd.NA]
    assert table["reason"].tolist() == ["", "too few charts", "fused.trusted", ""]
    assert "fused.trusted" in table


def test_what_varies_is_told_as_it_was_given() -> None:
    table = tabled(arena=["pillar", "furnished"], views=[300, 200])
    assert table["arena"].tolist() == ["furnished"] * 4 + ["pillar"] * 4
    assert table["views"].tolist() == [200, 200, 300, 300] * 2
