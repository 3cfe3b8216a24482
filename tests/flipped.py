"""One small of everything that is written, and what comes of reading it when a bit of it has flipped."""

from collections import Counter
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from torch import Tensor

from arena import Arena, ArenaError, Babble, Camera, Recording, explore
from cogmap import CogmapError, CognitiveMap, EvenMemory, GeneralisedCoordinates, MotorModel, check
from cogmap.coordinates import view_code
from cogmap.map.activity import Activity
from cogmap.map.storage import read_state

LOADERS: dict[str, Callable[[Path], Any]] = {
    "map": CognitiveMap.load,
    "memory": EvenMemory.load,
    "motor": MotorModel.load,
    "coordinates": GeneralisedCoordinates.load,
}


def write_all(folder: Path, *, views: int) -> dict[str, Path]:
    """Write a recording, a map, a memory, a motor model and coordinates; tells where each lies."""
    rng = np.random.default_rng(0)
    walk = explore(Arena.load("white_rectangle"), Babble(), Camera.panoramic(90, 15), views=views, seed=0)
    wifi, licks = rng.normal(-60, 5, (views, 4)).astype(np.float32), rng.integers(0, 2, views).astype(bool)
    walk = replace(walk, odours=np.exp(rng.normal(size=(views, 3))).astype(np.float32))
    walk = replace(walk, signals={"wifi": wifi, "licks": licks})
    angles = rng.uniform(-np.pi, np.pi, 400)
    spots = np.exp(4 * np.cos(angles[:, None] - np.linspace(-np.pi, np.pi, 24, endpoint=False)) - 4)
    ring = np.tile((200 * spots).astype(np.uint8)[:, None, :, None], (1, 8, 1, 3))
    position, phase = np.cumsum(rng.normal(size=(60, 2)), axis=0), np.linspace(0, 3, 60)
    steps = _activity(position, phase), _activity(position + 0.1, phase + 0.1)
    cmap = CognitiveMap(charts=6, components=4, place_cells=4, heading_cells=4, epoch=30)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(view_code, "STEPS", 10)
        coordinates = GeneralisedCoordinates(components=4).fit(ring)
    made = {
        "recording": walk,
        "map": cmap.partial_fit(walk.views[:90], walk.odours[:90]),
        "memory": EvenMemory(8).partial_fit(rng.normal(size=(20, 3)), rng.normal(size=(20, 2))),
        "motor": MotorModel().partial_fit(rng.uniform(-1, 1, (60, 2)), *steps),
        "coordinates": coordinates,
    }
    for kind, thing in made.items():
        thing.save(folder / kind)
    return {kind: folder / kind for kind in made}


def _activity(position: np.ndarray, phase: np.ndarray) -> Activity:
    """What a map perceives, for those who learn of position and phase alone."""
    none = np.zeros((len(phase), 0), np.float32)
    return Activity(none, none, phase.astype(np.float32), none, position.astype(np.float32))


def read(kind: str, path: Path) -> dict[str, Any]:
    """Everything that is read of it, by name, to be compared."""
    if kind == "recording":
        rec = Recording.open(path)[:]
        return {"views": _bits(rec.views), "attributes": repr(rec.attributes)} | {
            name: _bits(values) for name, values in rec._columns.items()
        }
    LOADERS[kind](path)
    weights, settings, learnt = read_state(path, kind=kind)
    return {"settings": repr(settings), "learnt": repr(learnt)} | {
        f"weight {name}": _bits(weight) for name, weight in weights.items()
    }


def _bits(values: np.ndarray | Tensor) -> tuple[str, tuple[int, ...], bytes]:
    array = np.asarray(values)
    return str(array.dtype), array.shape, array.tobytes()


@dataclass
class Judge:
    """Damages what was written, reads it, and mends it again."""

    places: dict[str, Path]

    def __post_init__(self) -> None:
        self.wanted = {kind: read(kind, path) for kind, path in self.places.items()}
        self.files = [
            (kind, file)
            for kind, path in self.places.items()
            for file in sorted(path.rglob("*"))
            if file.is_file()
        ]

    def verdict(self, kind: str, *, checked: bool = False) -> str:
        """What comes of reading it: refused, harmless or believed; `checked` asks `cogmap.check`, too."""
        path = self.places[kind]
        try:
            found = read(kind, path)
        except (ArenaError, CogmapError) as error:
            verdict, said = "refused", str(error)
        else:
            verdict, said = "harmless" if found == self.wanted[kind] else "believed", str(path)
        assert len(said.splitlines()) == 1
        assert str(path) in said
        if checked:
            told = check(path)
            assert told.whole == (verdict == "harmless"), (verdict, told)
            assert bool(told.sentence) != told.whole
        return verdict

    @contextmanager
    def flipped(self, file: Path, bit: int):
        """Flip one bit of a file meanwhile."""
        sound = file.read_bytes()
        damaged = bytearray(sound)
        damaged[bit // 8] ^= 1 << bit % 8
        file.write_bytes(damaged)
        try:
            yield
        except Exception as error:
            error.add_note(f"bit {bit} of {file}")
            raise
        finally:
            file.write_bytes(sound)

    def flip(self, count: int, *, seed: int, check_every: int) -> Counter[tuple[str, str]]:
        """Flip bits, each in a file drawn among all; how often which kind of thing had which verdict."""
        rng = np.random.default_rng(seed)
        found = Counter[tuple[str, str]]()
        for number in range(count):
            kind, file = self.files[number % len(self.files)]
            with self.flipped(file, int(rng.integers(8 * file.stat().st_size))):
                verdict = self.verdict(kind, checked=number % check_every == 0)
            assert verdict != "believed", file
            found[kind, verdict] += 1
        return found
