import pytest

from arena import Camera
from cogmap.experiments.acting import dynamics
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.registry import run_experiment
from tests.cogmap.conftest import Refined


def test_a_second_is_foretold_and_stops_are_counted(
    refined: Refined, camera: Camera, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in {"BODIES": 1, "JOURNEYS": 2, "LONGEST": 3.0}.items():
        monkeypatch.setattr(dynamics, name, value)
    monkeypatch.setattr(Camera, "panoramic", lambda *_, **__: camera)
    monkeypatch.setattr(dynamics, "grow_map", lambda *_, **__: refined.cmap)
    monkeypatch.setattr(type(refined.cmap), "refine", lambda cmap, _: cmap)
    monkeypatch.setattr(Conditions, "explore", lambda *_, **__: refined.walk)
    result = run_experiment("dynamics", views=len(refined.walk), room=refined.room)
    figures, table = result.metrics, result.tables["stops"]
    assert table["model"].value_counts().to_dict() == {"second order": 2, "first order": 2, "true pose": 2}
    assert figures["journeys"] == 2
    for name, model in (("stopped", "second order"), ("first_order", "first order"), ("true", "true pose")):
        stops = table[table["model"] == model]
        inside = stops["stopped"] & (stops["position_error_m"] <= dynamics.STOPPED)
        assert figures[f"{name}_within_3cm"] == inside.mean()
        assert figures[f"{name}_median_m"] == stops["position_error_m"].median()
    assert figures["ahead_1s_psnr_db"] > figures["first_order_ahead_psnr_db"]
    assert figures["ahead_1s_psnr_db"] > figures["persistence_psnr_db"] + 5
    assert figures["true_ahead_psnr_db"] > 30
    assert set(result.figures) == {"stops", "foretold"} == set(result.captions)
