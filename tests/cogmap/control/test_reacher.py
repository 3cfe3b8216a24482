"""A whole small life: a map, babbling, and journeys through the physics by sight alone."""

import inspect
from copy import copy

import numpy as np
import pytest

from arena import Arena, Camera, Disc, Policy
from cogmap import CogmapError, EvenMemory
from cogmap.control import Outcome, Reacher
from cogmap.experiments.acting.travels import draw_poses, scored, summary, travel
from tests.cogmap.conftest import Refined


def test_images_are_reached_by_sight_alone(refined: Refined, camera: Camera) -> None:
    rng = np.random.default_rng(0)
    starts, goals = (draw_poses(refined.room, Disc().radius, 6, rng) for _ in range(2))
    go = Reacher(refined.cmap, refined.motor).towards(camera.render(refined.room, goals))
    assert isinstance(go, Policy)
    assert list(inspect.signature(go.__call__).parameters) == ["sensed"]
    gone = travel(refined.room, go, camera, starts, body=Disc(), seed=0)
    found = summary(scored(refined.room, gone, goals, Disc()))
    assert (go.outcomes_ == Outcome.ARRIVED).all()
    assert found["within_5cm_2deg"] == 1
    assert found["position_median_m"] < 0.01
    assert found["heading_median_deg"] < 0.25
    assert found["touching"] == 0
    assert found["path_ratio_median"] < 1.05


def test_one_goal_makes_a_policy_for_one(refined: Refined, camera: Camera) -> None:
    view = camera.render(refined.room, np.array([[0.4, 0.2, 1.0]]))[0]
    go = Reacher(refined.cmap, refined.motor).towards(view)
    for _ in range(2):
        command = go({"view": view})
    assert command is None
    assert go.outcomes_.tolist() == [Outcome.ARRIVED]


@pytest.mark.parametrize("kind", ["views", "even memory"])
def test_ways_lead_over_the_memory_that_is_given(refined: Refined, kind: str) -> None:
    views = refined.walk.views[::6]
    memory = views if kind == "views" else EvenMemory(200).partial_fit(views, refined.cmap.encode(views))
    kept = views if kind == "views" else memory.views_
    reacher = Reacher(refined.cmap, refined.motor, memory=memory)
    np.testing.assert_allclose(reacher.ways.position, refined.cmap.perceive(kept).position)
    own = Reacher(refined.cmap, refined.motor).ways.position
    np.testing.assert_array_equal(own, refined.cmap.relaxed_places_.places_)


def test_bad_goals_are_told_in_one_sentence(refined: Refined, camera: Camera) -> None:
    reacher, black = Reacher(refined.cmap, refined.motor), np.zeros((15, 90, 3), np.uint8)
    here = np.array([[0.3, 0.2, 0.0]])
    elsewhere = camera.render(Arena.load("two_rooms"), np.array([[-1.7, 0.0, 0.4]]))[0]
    noise = np.random.default_rng(0).integers(0, 256, black.shape).astype(np.uint8)
    for goal, sentence in [
        (black, "nothing that this map remembers"),
        (elsewhere, "nothing that this map remembers"),
        (noise, "nothing that this map remembers"),
        (Camera.panoramic(180, 30).render(refined.room, here)[0], "camera the map was learnt with"),
        (black.astype(float), "uint8"),
    ]:
        with pytest.raises(CogmapError, match=sentence):
            reacher.towards(goal)
    view = camera.render(refined.room, here)[0]
    coarse = copy(refined.cmap)
    coarse.relaxed_places_, coarse.refine_reason_ = None, "why"
    with pytest.raises(CogmapError, match="too coarse to act on: why"):
        Reacher(coarse, refined.motor).towards(view)
