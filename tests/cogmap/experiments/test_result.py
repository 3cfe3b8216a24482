import json
from pathlib import Path

import matplotlib.image
import pandas as pd

from cogmap.experiments.result import USUAL_CAPTIONS, Result
from cogmap.plots.style import new_figure


def test_everything_is_written_and_reads_back(tmp_path: Path) -> None:
    figure = new_figure(2.0, 1.0)
    figure.subplots().plot([0, 1])
    table = pd.DataFrame({"view": [3, 5], "error_m": [0.25, 0.5]})
    Result({"views": 2, "betti": [1, 1, 0]}, {"errors": table}, {"line": figure}, {"line": "A line"}).write(
        tmp_path
    )
    assert json.loads((tmp_path / "captions.json").read_text(encoding="utf-8")) == {"line": "A line"}
    assert json.loads((tmp_path / "metrics.json").read_text(encoding="utf-8")) == {
        "views": 2,
        "betti": [1, 1, 0],
    }
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / "errors.parquet"), table)
    assert matplotlib.image.imread(tmp_path / "line.png").std() > 0.01
    pd.testing.assert_frame_equal(pd.read_csv(tmp_path / "errors.csv"), table)
    assert len(list(tmp_path.iterdir())) == 5


def test_described_it_tells_what_it_is_of_and_has_the_usual_captions() -> None:
    figures = {name: new_figure(1.0, 1.0) for name in ("walk", "room", "barcodes", "odd_one")}
    own = {"barcodes": "Bars of a spin", "walk": "The way", "torus": "Not drawn"}
    found = Result({"views": 2, "r2": 0.5}, figures=figures, captions=own).described({"seed": 3, "views": 9})
    assert found.metrics == {"seed": 3, "views": 2, "r2": 0.5}
    assert list(found.captions.items()) == [
        ("walk", "The way"),
        ("room", USUAL_CAPTIONS["room"]),
        ("barcodes", "Bars of a spin"),
    ]


def test_results_are_joined_and_the_second_goes_first() -> None:
    line, dot = new_figure(1.0, 1.0), new_figure(1.0, 1.0)
    one = Result({"views": 2, "r2": 0.5}, {"a": pd.DataFrame()}, {"line": line}, {"line": "A line"})
    both = one.joined(Result({"r2": 0.7}, {"b": pd.DataFrame()}, {"dot": dot}, {"line": "The line"}))
    assert both.metrics == {"views": 2, "r2": 0.7}
    assert list(both.tables) == ["a", "b"]
    assert both.figures == {"line": line, "dot": dot}
    assert both.captions == {"line": "The line"}
