import numpy as np
import pandas as pd
import pytest

from arena import Arena, Camera
from cogmap.experiments import Conditions
from cogmap.experiments.controls.development_and_lesions import _agreement, _mature, development
from cogmap.experiments.result import Result

VIEWS = 2000


@pytest.fixture(scope="module")
def result() -> Result:
    few = {"place_cells": 80, "heading_cells": 30}
    conditions = Conditions(Arena.load("furnished"), VIEWS, camera=Camera.panoramic(90, 15), map=few)
    return development(conditions, after=(30, 300), silent=(0.0, 0.5))


def test_cells_grow_with_experience(result: Result) -> None:
    growth = result.tables["growth"]
    assert growth["views"].tolist() == [30, 300, VIEWS]
    first, last = growth.iloc[0], growth.iloc[-1]
    for name in ("place_cells_passing", "heading_cells_passing", "place_coverage"):
        assert first[name] < 0.5 * last[name]
    assert first["position_median_m"] > 1.5 * last["position_median_m"]
    assert first["heading_median_deg"] > 2 * last["heading_median_deg"]


def test_place_cells_that_smell_first_are_there_before_the_eyes_open(result: Result) -> None:
    told, courses = result.metrics["smell_first"], result.tables["smell_first"]
    dark, opened = (courses[courses["sensed"] == sense] for sense in ("smell", "sight"))
    assert dark["views"].tolist() == opened["views"].tolist() == [30, 300, VIEWS]
    assert dark["place_cells_passing"].iloc[-1] > 0.5
    assert (dark["heading_cells_passing"] == 0).all()
    assert opened["place_cells_passing"].iloc[0] < 0.5 * opened["place_cells_passing"].iloc[-1]
    assert opened["heading_cells_passing"].iloc[-1] > 0.8
    assert told["views_to_mature"].keys() == {"place", "heading"}
    assert told["views_to_mature_in_the_dark"] in dark["views"].tolist()


def test_what_has_grown_again_is_what_there_was(result: Result) -> None:
    assert result.metrics["growth"][-1].keys() - {"views"} == result.metrics["driven"].keys()
    for name, value in result.metrics["driven"].items():
        assert result.metrics["growth"][-1][name] == pytest.approx(value, rel=0.02)
        assert result.metrics["silencing"][0][name] == pytest.approx(value)


def test_cells_outlast_charts(result: Result) -> None:
    silencing = result.tables["silencing"]
    assert tuple(silencing["silent"]) == (0.0, 0.5)
    whole, half = silencing.iloc[0], silencing.iloc[-1]
    assert half["place_cells_passing"] > 0.7 * whole["place_cells_passing"]
    assert half["position_median_m"] < 1.5 * whole["position_median_m"]
    assert whole["heading_median_deg"] < half["heading_median_deg"] < 2 * whole["heading_median_deg"]


def test_weights_smooth_what_is_recalled(result: Result) -> None:
    agreement = result.metrics["agreement"]
    assert agreement["heading"] > 0.95
    assert 0.2 < agreement["place"] < 1
    assert result.metrics["direct"].keys() == result.metrics["driven"].keys()
    assert set(result.tables["cells"]["population"]) == {
        "driven, place",
        "driven, heading",
        "direct, place",
        "direct, heading",
    }


def test_weights_lie_where_the_cell_fires(result: Result) -> None:
    afferents, cells = result.tables["afferents"], result.tables["cells"]
    assert (afferents["weight_hz"] >= 1).all()
    place = afferents[afferents["population"] == "place"]
    pull = place["weight_hz"]
    centres = place.assign(x=pull * place["x_m"], y=pull * place["y_m"]).groupby("cell")[["x", "y"]].sum()
    centres = centres.div(pull.groupby(place["cell"]).sum(), axis=0)
    fields = cells[cells["population"] == "driven, place"].reset_index(drop=True)[
        ["centre_x_m", "centre_y_m"]
    ]
    away = np.linalg.norm(centres.to_numpy() - fields.loc[centres.index].to_numpy(), axis=1)
    assert np.nanmedian(away) < 0.25


def test_it_draws_weights_and_courses(result: Result) -> None:
    assert result.figures.keys() == {"afferents", "courses"}
    assert result.metrics["views_to_mature"].keys() == {"place", "heading"}


@pytest.mark.parametrize(
    ("passing", "views"), [([0, 0.5, 0.95, 1.0], 300), ([0.95, 0.5, 0.8, 1.0], 1000), ([0, 0, 0, 0], 30)]
)
def test_mature_is_for_good(passing: list[float], views: int) -> None:
    growth = pd.DataFrame({"views": [30, 100, 300, 1000], "cells": passing})
    assert _mature(growth, "cells") == views


def test_agreement_is_the_median_correlation() -> None:
    rng = np.random.default_rng(0)
    one, other = rng.random((2, 50, 5))
    expected = [np.corrcoef(one[:, cell], other[:, cell])[0, 1] for cell in range(5)]
    assert _agreement(one, other) == pytest.approx(np.median(expected))
    other[:, 0] = 0
    assert _agreement(one, other) == pytest.approx(np.median(expected[1:]))
