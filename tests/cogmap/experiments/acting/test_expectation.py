import pytest

from arena import Arena
from cogmap.experiments.acting import expectation
from cogmap.experiments.acting.dreamer import Dreamer
from cogmap.experiments.registry import run_experiment
from tests.cogmap.conftest import Refined


def test_what_is_expected_is_more_like_what_comes(
    dreamer: Dreamer, refined: Refined, room: Arena, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert dreamer.trial.conditions.room is room
    monkeypatch.setattr(expectation, "STEPS", 20)
    monkeypatch.setattr(expectation, "BABBLED", 200)
    monkeypatch.setattr(expectation, "babble", lambda *_: refined.motor)
    result = run_experiment("expectation", views=200, room=room)
    figures, table = result.metrics, result.tables["steps"]
    straight = table[table["straight"]]
    assert (straight["step_m"] > expectation.LONG).all()
    assert 0 < len(straight) == figures["steps"] < len(table)
    assert figures["ahead_psnr_db"] == straight["ahead_psnr_db"].median()
    assert figures["all_psnr_db"] == table["ahead_psnr_db"].median()
    assert figures["ahead_psnr_db"] > figures["turned_psnr_db"] > figures["persistence_psnr_db"]
    assert result.figures.keys() == result.captions.keys() == {"expected"}
