from collections.abc import Callable

import pytest

from arena import Camera
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.registry import run_experiment
from cogmap.experiments.rooms import returning
from cogmap.experiments.trial import Trial


@pytest.mark.near_guard  # what is forgotten does not depend on what is trusted
def test_nothing_is_forgotten_and_the_room_is_known_again(
    monkeypatch: pytest.MonkeyPatch, two_rooms_of_house: Callable[[Conditions], list[Trial]], eye: Camera
) -> None:
    monkeypatch.setattr(returning, "house_of", two_rooms_of_house)
    found = run_experiment("returning", views=900, camera=eye)
    metrics = found.metrics
    assert metrics["rooms"] == 2
    assert metrics["forgotten_heading_deg"] == pytest.approx(0, abs=1)
    assert metrics["forgotten_position_m"] == pytest.approx(0, abs=0.01)
    assert metrics["return_correlation"] > 0.97
    assert list(found.tables["rooms"]["rooms"]) == [1, 2]
    assert found.figures.keys() == found.captions.keys() == {"forgetting"}
