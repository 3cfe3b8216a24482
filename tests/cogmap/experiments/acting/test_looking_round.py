import pytest

from arena import Camera
from cogmap.experiments.acting import looking_round
from cogmap.experiments.registry import run_experiment


def test_one_blue_wall_tells_and_a_white_room_never_does(monkeypatch: pytest.MonkeyPatch) -> None:
    look = Camera.perspective
    monkeypatch.setattr(Camera, "perspective", lambda *_: look(24, 18))
    monkeypatch.setattr(looking_round, "QUERIES", 60)
    result = run_experiment("looking_round", views=1500)
    figures = result.metrics
    for name, table in result.tables.items():
        assert len(table) == 60
        assert figures[f"{name}_share_right_after"] == table["right_after"].mean()
        assert table["turned_deg"].between(0, 30 + 1e-9).all()
    assert figures["blue_wall_share_right_after"] > figures["blue_wall_share_right_before"]
    assert figures["white_share_resolved"] == 0
    assert result.figures.keys() == result.captions.keys() == {"looking_round"}
