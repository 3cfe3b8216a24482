import pytest

from tests.cogmap.rat import Rat, walk_and_fire


@pytest.fixture(scope="session")
def rat() -> Rat:
    return walk_and_fire()
