import pytest

from arena import Camera
from cogmap.experiments.acting import dynamics
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.registry import run_experiment
from tests.cogmap.conftest import Refined


def test_it_stops_where_a_model_of_first_order_does_not(
    refined: Refined, camera: Camera, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in {"BODIES": 1, "JOURNEYS": 3, "LONGEST": 30.0}.items():
        monkeypatch.setattr(dynamics, name, value)
    monkeypatch.setattr(Camera, "panoramic", lambda *_, **__: camera)
    monkeypatch.setattr(dynamics, "grow_map", lambda *_, **__: refined.cmap)
    monkeypatch.setattr(type(refined.cmap), "refine", lambda cmap, _: cmap)
    monkeypatch.setattr(Conditions, "explore", lambda *_, **__: refined.walk)
    result = run_experiment("dynamics", views=len(refined.walk), room=refined.room)
    figures, table = result.metrics, result.tables["stops"]
    print(figures)
    assert table["model"].value_counts().to_dict() == {"second order": 3, "first order": 3, "true pose": 3}
    assert figures["journeys"] == 3
    assert figures["stopped_within_3cm"] == figures["true_within_3cm"] == 1
    assert figures["ahead_1s_psnr_db"] > figures["first_order_ahead_psnr_db"]
    assert figures["ahead_1s_psnr_db"] > figures["persistence_psnr_db"] + 5
    assert set(result.figures) == {"stops", "foretold"} == set(result.captions)
