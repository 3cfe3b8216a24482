import base64
import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cogmap import CogmapError
from cogmap.experiments.registry import experiments
from cogmap.experiments.result import Result
from cogmap.pages.report.contents import LONGEST, read_contents
from cogmap.plots.style import new_figure


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    figure = new_figure(2.0, 1.0)
    figure.subplots().plot([0, 1])
    table = pd.DataFrame({"error_m": [0.5, 0.25, np.nan, 4.0], "split": list("aabb"), "known": [True] * 4})
    metrics = {
        "experiment": "cyclic",
        "arena": "pillar",
        "views": 9,
        "seed": 4,
        "error_deg": 1.23456,
        "s": {"a": 1},
    }
    Result(metrics, {"errors": table}, {"walk": figure, "odd_one": figure}, {"walk": "The way"}).write(
        tmp_path
    )
    return tmp_path


def test_an_experiment(folder: Path) -> None:
    (folder / "about.json").write_text(
        json.dumps({"command": "cogmap it", "different": {"nose": "Nose()"}, "versions": {"numpy": "2"}}),
        "utf-8",
    )
    (folder / "arena.toml").write_text("walls = []", "utf-8")
    found = read_contents(folder)
    assert found.title == "Cyclic in pillar"
    assert found.summary == experiments()["cyclic"].summary
    assert found.parameters == [
        ("experiment", "cyclic", ""), ("arena", "pillar", ""), ("views", "9", ""), ("seed", "4", ""),
        ("nose", "Nose()", ""),
    ]  # fmt: skip
    assert found.figures == [("error_deg", "1.235", "°"), ("s.a", "1", "")]
    assert [(one.name, one.caption, one.width, one.height) for one in found.pictures] == [
        ("odd_one", "Odd one", 220, 110),
        ("walk", "The way", 220, 110),
    ]
    data = base64.b64decode(found.pictures[1].uri.removeprefix("data:image/png;base64,"))
    assert data == (folder / "walk.png").read_bytes()
    (table,) = found.tables
    assert (table.name, table.note, table.opened) == ("errors.parquet", "4 rows", False)
    assert table.columns == ["column", "least", "median", "greatest"]
    assert table.rows == [
        ["error_m", "0.25", "0.5", "4"], ["split", "", "2 different", ""], ["known", "", "1 different", ""],
    ]  # fmt: skip
    assert found.files == {"arena.toml": "walls = []"}
    assert (found.command, found.versions) == ("cogmap it", {"numpy": "2"})


def test_without_a_record_of_the_command(folder: Path) -> None:
    found = read_contents(folder)
    assert (found.command, found.versions, found.files) == ("", {}, {})


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_a_sweep(tmp_path: Path, ending: str) -> None:
    table = pd.DataFrame({"nose.noise": np.arange(LONGEST + 1) / 4, "error": [None, *["boom"] * LONGEST]})
    (table.to_csv if ending == "csv" else table.to_parquet)(tmp_path / f"table.{ending}", index=False)
    (tmp_path / "plan.toml").write_text("views = 1", "utf-8")
    (tmp_path / "figures").mkdir()
    figure = new_figure(2.0, 1.0)
    figure.subplots().plot([0, 1])
    figure.savefig(tmp_path / "figures" / "mean_rate.png")
    found = read_contents(tmp_path)
    assert found.title == "Sweep"
    (shown,) = found.tables
    assert shown.opened
    assert shown.note == f"{LONGEST + 1} rows, the first {LONGEST} of which are shown"
    assert shown.columns == ["nose.noise", "error"]
    assert shown.rows[:2] == [["0", "–"], ["0.25", "boom"]]
    assert len(shown.rows) == LONGEST
    assert found.files == {"plan.toml": "views = 1"}
    assert [(one.name, one.caption) for one in found.pictures] == [("figures/mean_rate", "Mean rate")]


def test_a_sweeps_table_is_shown_once(tmp_path: Path) -> None:
    for write in (lambda table: table.to_csv, lambda table: table.to_parquet):
        table = pd.DataFrame({"seed": [0]})
        write(table)(tmp_path / f"table.{write(table).__name__.removeprefix('to_')}", index=False)
    assert [table.name for table in read_contents(tmp_path).tables] == ["table.parquet"]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("metrics.json", "{"), ("metrics.json", "[]"), ("about.json", "x"), ("walk.png", "GIF8"),
        ("walk.png", "\x89PNG"), ("errors.parquet", "PAR1junk"), ("table.csv", ""), ("table.parquet", "x"),
        ("short.png", "\x89PNG\r\n\x1a\n123"),
    ],
)  # fmt: skip
def test_damage_is_named(folder: Path, name: str, text: str) -> None:
    (folder / name).write_text(text, encoding="latin-1", newline="")
    with pytest.raises(CogmapError, match=rf"{name} is damaged: .*run what wrote it again"):
        read_contents(folder)


def test_what_is_no_result(tmp_path: Path) -> None:
    (tmp_path / "diary.txt").write_text("mine", encoding="utf-8")
    for path in (tmp_path, tmp_path / "absent", tmp_path / "diary.txt"):
        with pytest.raises(CogmapError, match="is not the result of a demo, an experiment or a sweep"):
            read_contents(path)
