from typing import Any

import pytest

from arena import Box, Camera, Disc
from cogmap.pages.live.mind import Mind
from cogmap.pages.live.session import Session
from cogmap.pages.live.world import World

BOX = Box(center=(2.8, 2.3), size=(0.15, 0.15), material="blue", height=0.2)


@pytest.fixture(scope="session")
def world(refined: Any, camera: Camera) -> World:
    """The room of the map, and in a corner a small box that it has not seen."""
    room = refined.room.model_copy(update={"boxes": (BOX,)})
    mind = Mind(refined.cmap, memory=refined.walk.views, motor=refined.motor)
    return World(room, camera, Disc(), mind, refined.walk, replays={"walk": refined.walk})


@pytest.fixture
def session(world: World) -> Session:
    return Session(world, seed=0)
