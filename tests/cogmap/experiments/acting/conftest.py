from dataclasses import replace

import pytest

from arena import Arena, Brownian, Camera, Recording, explore
from cogmap.experiments.acting.dreamer import Dreamer
from cogmap.experiments.acting.surprise import with_a_box
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.trial import Trial
from tests.cogmap.conftest import Refined

REMEMBERED, FRESH = 600, 40


@pytest.fixture(scope="session")
def room(refined: Refined) -> Arena:
    """The room of the small map, with a box beside its platform."""
    return with_a_box(refined.room)


@pytest.fixture(scope="session")
def remembered(refined: Refined, room: Arena, camera: Camera) -> Recording:
    """Part of the walk that the map was learnt from, as it looks with the box."""
    walk = refined.walk[:REMEMBERED]
    return replace(walk, views=camera.render(room, walk.require("poses")))


@pytest.fixture
def dreamer(
    refined: Refined, room: Arena, remembered: Recording, camera: Camera, monkeypatch: pytest.MonkeyPatch
) -> Dreamer:
    """What experiments on imagination are given: a small map, few views, a small eye."""
    fresh = explore(room, Brownian(), camera, views=FRESH, seed=1)
    trial = Trial(Conditions(room, REMEMBERED), remembered, fresh)
    trial.__dict__["cmap"] = refined.cmap
    dreamer = Dreamer(trial)
    monkeypatch.setattr(Dreamer, "of", lambda _: dreamer)
    monkeypatch.setattr(Camera, "panoramic", lambda *_, **__: camera)
    return dreamer
