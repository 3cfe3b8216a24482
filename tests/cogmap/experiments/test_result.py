import json
from pathlib import Path

import matplotlib.image
import pandas as pd

from cogmap.experiments.result import Result
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
