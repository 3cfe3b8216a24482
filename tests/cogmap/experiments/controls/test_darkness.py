from arena import Camera
from cogmap.experiments.registry import run_experiment


def test_the_same_cells_tell_the_same_place_by_either_sense() -> None:
    result = run_experiment("darkness", views=2000, camera=Camera.panoramic(90, 15))
    sight, smell = result.metrics["sight"], result.metrics["smell"]
    assert result.metrics["map_correlation"] > 0.5
    assert sight["place_cells_passing"] > 0.5
    assert sight["heading_cells_passing"] > 0.5
    assert smell["place_cells_passing"] > 0.5
    assert smell["heading_cells_passing"] == 0
    assert "heading_median_deg" not in smell
    assert 1.2 * sight["position_median_m"] < smell["position_median_m"]
    assert result.tables["cells"].groupby("population").size().to_dict() == {
        "sight, place": 150,
        "sight, heading": 60,
        "smell, place": 150,
        "smell, heading": 60,
    }
