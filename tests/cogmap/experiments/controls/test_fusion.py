from typing import Any

import pytest

from arena import Arena, Camera
from cogmap.experiments.registry import experiments, run_experiment
from cogmap.experiments.result import Result


@pytest.fixture(scope="module")
def result() -> Result:
    room = Arena.load("furnished")
    return run_experiment("fusion", views=5000, camera=Camera.panoramic(90, 15), room=room)


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


def test_a_smell_made_of_panoramas_does_as_well(metrics: dict[str, Any]) -> None:
    seen = metrics["visual_smell"]
    assert seen["place_cells_passing"] > 0.7
    assert seen["heading_cells_passing"] > 0.8
    assert seen["position_median_m"] < 0.1
    assert seen["heading_median_deg"] < 5


def test_smell_competes_or_does_not_on_the_same_walks(metrics: dict[str, Any]) -> None:
    assert metrics["competition"].keys() == {"furnished"}
    told = metrics["competition"]["furnished"]
    shared = told["with_smell"].keys() & metrics["fused"].keys()
    assert {key: told["with_smell"][key] for key in shared} == {key: metrics["fused"][key] for key in shared}
    assert told["sight_alone"]["position_median_m"] != told["with_smell"]["position_median_m"]
    assert told["sight_alone"]["place_cells_passing"] > 0.8
    assert (experiments()["fusion"].room, *experiments()["fusion"].extra_rooms) == ("furnished", "cue_square")


def test_every_figure_that_applies_is_there(metrics: dict[str, Any]) -> None:
    cells = {"place_cells_passing", "place_coverage", "heading_cells_passing", "in_field_direction_vector"}
    position = {"position_median_m", "position_p95_m"}
    heading = {"heading_median_deg", "heading_p95_deg", "heading_resultant"}
    metric = {"metric_map_r2", "metric_map_median_m"}
    nose = {f"nose_{key}" for key in position}
    assert metrics["vision_only"].keys() >= cells
    assert metrics["olfaction_only"].keys() >= cells | position
    assert metrics["fused"].keys() >= cells | position | heading | metric | nose | {"trusted", "seconds"}
    assert metrics["fused"]["metric_map_r2"] > 0.9


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
