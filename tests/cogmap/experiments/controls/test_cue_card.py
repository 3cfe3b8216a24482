import numpy as np
import pytest

from arena import Arena, Camera
from cogmap.errors import CogmapError
from cogmap.experiments.controls.cue_card import with_card_turned
from cogmap.experiments.registry import experiments, run_experiment


@pytest.mark.parametrize("name", ["cue_square", "cue_cylinder"])
def test_only_the_card_turns(name: str) -> None:
    before = Arena.load(name)
    after = with_card_turned(before)
    assert before.walls == after.walls
    assert before.sources == after.sources
    camera = Camera.panoramic(90, 15)
    pose = np.array([[0.7, 0.2, 0.4]])
    follows = np.array([[-0.2, 0.7, 0.4 + np.pi / 2]])
    same, moved = camera.render(before, pose).astype(int), camera.render(after, follows).astype(int)
    assert np.abs(same - moved).mean() < 0.5
    assert np.abs(same - camera.render(after, pose)).mean() > 5


def test_cells_follow_the_card_in_the_light_and_smells_in_the_dark() -> None:
    room, eye = Arena.load("cue_cylinder"), Camera.panoramic(90, 15)
    result = run_experiment("cue_card", views=1000, camera=eye, room=room)
    found = result.metrics["cue_cylinder"]
    assert found["light"]["place_follows_card"] > 0.95
    assert found["dark"]["place_follows_card"] < 0.05
    assert "heading_shift_deg" not in found["dark"]
    assert found["dark"]["correlation_smells"] > found["faint"]["correlation_smells"] + 0.1
    assert set(result.tables["place_cells"]["sensed"]) == {"light", "both", "dark", "faint"}
    assert result.figures.keys() == result.captions.keys() == {"follows", "examples_cue_cylinder"}


def test_it_visits_both_rooms_of_the_gallery_that_have_a_card() -> None:
    found = experiments()["cue_card"]
    assert (found.room, *found.extra_rooms) == ("cue_square", "cue_cylinder")


@pytest.mark.parametrize(
    ("name", "says"), [("open_field", "no box or block"), ("furnished", "a quarter turn of 'furnished'")]
)
def test_rooms_without_a_card_to_turn_are_refused(name: str, says: str) -> None:
    with pytest.raises(CogmapError, match=says):
        with_card_turned(Arena.load(name))
