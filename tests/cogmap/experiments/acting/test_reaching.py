import numpy as np
import pandas as pd
import pytest

from arena import Camera
from cogmap.experiments.acting import reaching, travels
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.registry import run_experiment
from cogmap.experiments.result import Result
from tests.cogmap.conftest import Refined

pytestmark = pytest.mark.full  # eight conditions, each with a spell of babbling: half a minute


@pytest.fixture(scope="module")
def result(refined: Refined, camera: Camera) -> Result:
    with pytest.MonkeyPatch.context() as patch:
        for name, value in {"PAIRS": 3, "DISTURBED": 2, "GRID": 0.9, "SNAPSHOTS": 1}.items():
            patch.setattr(reaching, name, value)
        patch.setattr(travels, "MOST_STEPS", 40)
        patch.setattr(travels, "BABBLED", 120)
        patch.setattr(Camera, "panoramic", lambda *_, **__: camera)
        patch.setattr(reaching, "grow_map", lambda *_, **__: refined.cmap)
        patch.setattr(type(refined.cmap), "refine", lambda cmap, _: cmap)
        patch.setattr(Conditions, "explore", lambda *_, **__: refined.walk)
        return run_experiment("reaching", views=len(refined.walk), room=refined.room)


def test_every_condition_has_its_figures(result: Result) -> None:
    keys = {"within_5cm_2deg", "within_2cm_1deg", "path_ratio_median", "touching"}
    for prefix in ("", "slip_", "swapped_", "weak_", "delayed_", "true_", "plain_", "descent_"):
        assert {prefix + key for key in keys} <= result.metrics.keys()
    assert result.metrics["pairs"] == 3
    assert result.metrics["within_5cm_2deg"] == result.metrics["true_within_2cm_1deg"] == 1
    assert 0 < result.metrics["nearest_view_median_m"] < 0.2
    assert 0 <= result.metrics["descent_catchment"] <= 1


def test_metrics_are_those_of_the_table(result: Result) -> None:
    table = result.tables["journeys"]
    assert isinstance(table, pd.DataFrame)
    assert table["condition"].value_counts().to_dict() == {
        "in peace": 3, "slip": 2, "swapped": 2, "weak": 2, "delayed": 2, "true": 2, "plain": 2, "descent": 2,
    }  # fmt: skip
    peace = table[table["condition"] == "in peace"]
    assert (peace["outcome"] == "arrived").all()
    assert result.metrics["position_median_m"] == np.median(peace["position_error_m"])
    assert set(result.figures) == {"journeys", "reached", "catchment"} == set(result.captions)
