import numpy as np
import pytest

from arena import Arena, Camera
from cogmap.errors import CogmapError
from cogmap.experiments.controls.cue_rotation import square_room
from cogmap.experiments.registry import run_experiment


def test_what_is_seen_turns_with_the_walls_and_what_is_smelt_does_not() -> None:
    room = Arena.load("open_field")
    before, after = (square_room(room, turns) for turns in (0, 1))
    camera = Camera.panoramic(90, 15)
    pose = np.array([[0.7, 0.2, 0.4]])
    follows = np.array([[-0.2, 0.7, 0.4 + np.pi / 2]])
    same, moved = camera.render(before, pose).astype(int), camera.render(after, follows).astype(int)
    assert np.abs(same - moved).mean() < 0.5
    assert np.abs(same - camera.render(after, pose)).mean() > 5
    np.testing.assert_allclose(
        before.odours.concentration(pose[:, :2]), after.odours.concentration(pose[:, :2]), rtol=1e-9
    )


def test_sight_follows_the_walls_and_smell_stays() -> None:
    metrics = run_experiment("cue_rotation", views=2500, camera=Camera.panoramic(90, 15)).metrics
    assert metrics["place_follows_walls_light"] > 0.95
    assert metrics["place_follows_walls_dark"] < 0.05
    assert metrics["correlation_faint_smells"] < metrics["correlation_dark_smells"] - 0.1
    assert metrics["heading_follows_walls"] > 0.95
    assert abs(metrics["heading_shift_deg"] - 90) < 10


def test_a_room_of_too_few_walls_is_refused() -> None:
    bare = Arena.load("open_field")
    with pytest.raises(CogmapError, match="has 3 walls"):
        square_room(bare.model_copy(update={"walls": bare.model_dump()["walls"][:3]}), 0)
