from collections.abc import Callable

import pytest

from arena import Arena, Camera
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.rooms.many_rooms import trials_of
from cogmap.experiments.rooms.morph import repainted
from cogmap.experiments.trial import Trial

CORNERS = [[-0.8, -0.6], [0.8, -0.6], [0.8, 0.6], [-0.8, 0.6]]


@pytest.fixture(scope="session")
def small() -> Arena:
    """Look about on a platform that is small enough for a thousand views."""
    return Arena.load("furnished").model_copy(update={"platform": [CORNERS]})


@pytest.fixture
def two_rooms_of_house(small: Arena) -> Callable[[Conditions], list[Trial]]:
    """Give a house of two rooms with small platforms."""
    return lambda conditions: trials_of(conditions, [small, repainted(small)])


@pytest.fixture
def eye() -> Camera:
    return Camera.panoramic(90, 15)
