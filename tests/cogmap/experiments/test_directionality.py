import pytest

from cogmap.experiments.catalogue import experiment


@pytest.mark.full
def test_place_cells_are_directional_on_a_path_and_not_in_the_open() -> None:
    metrics = experiment("directionality").metrics
    assert metrics["open_field"]["fused"]["directional"] < 0.05
    assert metrics["open_field"]["fused"]["in_field_direction_vector"] < 0.1
    assert metrics["corridor"]["fused"]["directional"] > 0.9
    for walk in ("open_field", "corridor"):
        assert metrics[walk]["vision_only"]["directional"] > 0.95


def test_even_a_small_one_tells_path_from_field() -> None:
    result = experiment("directionality", views=1500)
    metrics = result.metrics
    assert metrics["open_field"]["fused"]["in_field_direction_vector"] < 0.4
    assert metrics["corridor"]["fused"]["directional"] > metrics["open_field"]["fused"]["directional"] + 0.4
    assert result.figures.keys() == {"cells", "examples_open_field", "examples_corridor"}
