from arena import Arena
from cogmap.experiments import Conditions
from cogmap.experiments.controls.field_of_view import field_of_view


def test_an_eye_with_borders_tells_places_and_misleads_the_compass() -> None:
    conditions = Conditions(Arena.load("furnished"), 1500, map={"charts": 300, "components": 20})
    result = field_of_view(conditions, degrees=(90.0,), rows=48)
    around, ahead = result.metrics["panorama"], result.metrics["perspective_90"]
    assert (around["eye_found"], ahead["eye_found"]) == ("panorama", "perspective")
    for found in (around, ahead):
        assert found["localised_position_median_m"] < 0.4
        assert len(found["betti"]) == len(found["betti_resolved"]) == 3
        assert found["trusted"] == (not found["reason"])
    assert around["dimension"] == 3
    assert result.tables["eyes"]["eye"].tolist() == ["panorama", "perspective_90"]
    assert set(result.figures) <= {"compass_panorama", "compass_perspective_90"}
