import numpy as np
import pytest

from arena import Arena
from cogmap.experiments import Conditions
from cogmap.experiments.controls.acuity import acuity, explore_at_acuity


def test_a_coarse_eye_has_large_pixels_on_the_same_walk() -> None:
    conditions = Conditions(Arena.load("furnished"), 60, seed=2)
    fine, coarse = (explore_at_acuity(conditions, columns).walk for columns in (360, 12))
    np.testing.assert_array_equal(fine.require("poses"), coarse.require("poses"))
    assert fine.views.shape == (60, 60, 360, 3)
    assert coarse.views.shape == (60, 16, 96, 3)
    blocks = np.asarray(coarse.views).reshape(60, 2, 8, 12, 8, 3)
    assert (np.ptp(blocks, axis=(2, 4)) == 0).all()
    means = np.asarray(fine.views).reshape(60, 2, 30, 12, 30, 3).mean(axis=(2, 4))
    assert np.abs(blocks[:, :, 0, :, 0] - means).mean() < 3
    assert explore_at_acuity(conditions, 24).fresh.views.shape == (60, 16, 96, 3)


def test_every_eye_and_number_of_charts_is_a_case() -> None:
    conditions = Conditions(Arena.load("furnished"), 2000, map={"place_cells": 60})
    result = acuity(conditions, eyes=(12, 90), shares=(0.125,))
    cases = result.tables["cases"].set_index(["columns", "charts"])
    assert sorted(cases.index) == [(12, 666), (90, 83), (90, 666)]
    blurred, coarse, usual = (cases.loc[case] for case in [(12, 666), (90, 83), (90, 666)])
    assert usual["place_cells_passing"] * 60 % 1 == pytest.approx(0, abs=1e-9)
    assert blurred["position_median_m"] > 1.5 * usual["position_median_m"]
    assert not coarse["trusted"]
    assert "charts" in coarse["reason"]
    assert coarse["place_cells_passing"] < 0.5 * usual["place_cells_passing"]
    assert coarse["heading_cells_passing"] == 0
    assert usual["heading_median_deg"] < 10
    assert result.metrics["90_columns_666_charts"]["position_median_m"] == usual["position_median_m"]
    assert result.figures.keys() == {"acuity"}
