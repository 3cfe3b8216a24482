from collections.abc import Callable, Iterator

import pytest

from arena import Arena, Brownian, Camera, Recording, explore
from cogmap import CognitiveMap
from cogmap.features import vocabulary

VIEWS, CHARTS = 5000, 1000


@pytest.fixture(scope="session")
def camera() -> Camera:
    return Camera.panoramic(90, 15)


@pytest.fixture(scope="session")
def walk(camera: Camera) -> Recording:
    return explore(Arena.load("furnished"), Brownian(), camera, views=VIEWS, seed=0)


@pytest.fixture(scope="session")
def grow() -> Callable[[Recording], CognitiveMap]:
    def fit(recording: Recording, *, seed: int = 0) -> CognitiveMap:
        return CognitiveMap(charts=CHARTS, components=40, seed=seed).fit(recording.views, recording.odours)

    return fit


@pytest.fixture(scope="session")
def cmap(walk: Recording, grow: Callable[[Recording], CognitiveMap]) -> CognitiveMap:
    return grow(walk)


@pytest.fixture(scope="module")
def few_words() -> Iterator[None]:
    """Look at small views, and learn words from few of their descriptors: most of a small experiment else."""
    look = Camera.perspective
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(vocabulary, "EXAMPLES", 2000)
        patch.setattr(Camera, "perspective", lambda w=160, h=120, **rest: look(w, h, **rest))
        yield
