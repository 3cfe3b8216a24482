from arena import Camera
from cogmap.experiments.registry import run_experiment


def test_even_a_small_one_tells_path_from_field() -> None:
    result = run_experiment("directionality", views=3000, camera=Camera.panoramic(90, 15))
    metrics = result.metrics
    assert metrics["open_field"]["fused"]["in_field_direction_vector"] < 0.4
    assert metrics["corridor"]["fused"]["directional"] > metrics["open_field"]["fused"]["directional"] + 0.4
    assert result.figures.keys() == {"cells", "examples_open_field", "examples_corridor"}
