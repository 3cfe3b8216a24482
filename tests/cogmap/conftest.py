from collections.abc import Callable, Iterator
from typing import NamedTuple

import pytest
from filelock import FileLock

from arena import Arena, Brownian, Camera, Disc, Recording, explore
from cogmap import CognitiveMap
from cogmap.control import MotorModel
from cogmap.experiments.acting.travels import babble
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


class Refined(NamedTuple):
    """A small map that is fine enough to act on, of a room without furniture."""

    room: Arena
    walk: Recording
    cmap: CognitiveMap
    motor: MotorModel


@pytest.fixture(scope="session")
def refined(
    camera: Camera, request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Refined:
    """Grown and refined once for all workers: the others load it."""
    room, base = Arena.load("open_field"), tmp_path_factory.getbasetemp()
    folder = base.parent if hasattr(request.config, "workerinput") else base
    with FileLock(folder / "refined.lock"):
        walk = explore(room, Brownian(), camera, views=3000, seed=0, out=folder / "refined.zarr")[:]
        if not (folder / "refined").exists():
            grown = CognitiveMap(charts=600, components=40).fit(walk.views, walk.odours)
            grown.refine(walk.views).save(folder / "refined")
        cmap = CognitiveMap.load(folder / "refined")
    return Refined(room, walk, cmap, babble(room, camera, cmap, Disc(), seed=0))


@pytest.fixture(scope="module")
def few_words() -> Iterator[None]:
    """Look at small views, and learn words from few of their descriptors: most of a small experiment else."""
    look = Camera.perspective
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(vocabulary, "EXAMPLES", 2000)
        patch.setattr(Camera, "perspective", lambda w=160, h=120, **rest: look(w, h, **rest))
        yield
