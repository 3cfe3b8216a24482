from typing import Any

import pytest

from cogmap.experiments.catalogue import experiment
from cogmap.experiments.result import Result


@pytest.fixture(scope="module")
def result() -> Result:
    return experiment("fusion", views=3000)


@pytest.fixture(scope="module")
def metrics(result: Result) -> dict[str, Any]:
    return result.metrics


def test_sight_alone_ties_cells_to_place_and_direction(metrics: dict[str, Any]) -> None:
    alone = metrics["vision_only"]
    assert alone["in_field_direction_vector"] > 0.9
    assert alone["place_cells_passing"] == alone["heading_cells_passing"] == 0


def test_smell_alone_tells_place_roughly_and_no_direction(metrics: dict[str, Any]) -> None:
    alone = metrics["olfaction_only"]
    assert alone["place_cells_passing"] > 0.7
    assert alone["heading_cells_passing"] == 0
    assert 0.12 < alone["position_median_m"] < 0.25
    assert alone["mean_vector_length"] < 0.4


def test_both_give_both(metrics: dict[str, Any]) -> None:
    fused = metrics["fused"]
    assert fused["trusted"]
    assert fused["place_cells_passing"] > 0.8
    assert fused["heading_cells_passing"] > 0.8
    assert fused["in_field_direction_vector"] < 0.25
    assert 2 * fused["position_median_m"] < fused["nose_position_median_m"]


def test_metrics_are_those_of_the_table(result: Result) -> None:
    cells = result.tables["cells"].groupby("population")
    assert cells.size().to_dict() == {
        "vision only": 150,
        "olfaction only": 150,
        "fused, place": 150,
        "fused, heading": 60,
    }
    passing = cells["place_passing"].mean()
    assert passing["fused, place"] == result.metrics["fused"]["place_cells_passing"]
    assert passing["olfaction only"] == result.metrics["olfaction_only"]["place_cells_passing"]
