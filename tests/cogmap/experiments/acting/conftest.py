from dataclasses import replace

import pytest

from arena import Arena, Brownian, Camera, explore
from cogmap.experiments.acting.dreamer import Dreamer
from cogmap.experiments.acting.surprise import with_a_box
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.trial import Trial
from tests.cogmap.conftest import Refined

REMEMBERED, FRESH = 1000, 30


@pytest.fixture(scope="session")
def room(refined: Refined) -> Arena:
    """The room of the small map, with a box beside its platform."""
    return with_a_box(refined.room)


@pytest.fixture(scope="session")
def small_dreamer(refined: Refined, room: Arena, camera: Camera) -> Dreamer:
    """A small map, and part of the walk that it was learnt from, as it looks with the box."""
    walk = refined.walk[:REMEMBERED]
    walk = replace(walk, views=camera.render(room, walk.require("poses")))
    fresh = explore(room, Brownian(), camera, views=FRESH, seed=1)
    trial = Trial(Conditions(room, REMEMBERED), walk, fresh)
    trial.__dict__["cmap"] = refined.cmap
    return Dreamer(trial)


@pytest.fixture
def dreamer(small_dreamer: Dreamer, camera: Camera, monkeypatch: pytest.MonkeyPatch) -> Dreamer:
    """What experiments on imagination are given, and look through."""
    monkeypatch.setattr(Dreamer, "of", lambda _: small_dreamer)
    monkeypatch.setattr(Camera, "panoramic", lambda *_, **__: camera)
    return small_dreamer
