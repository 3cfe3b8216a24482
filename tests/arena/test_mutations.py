"""Whatever is done to a room's file, it is a valid room or one clear error."""

import dataclasses
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.eye.camera import Camera
from arena.rooms.arena import Arena, gallery
from tests.arena.mutations import mutate

ROOMS = resources.files("arena") / "gallery"
TEXTS = [(ROOMS / f"{name}.toml").read_text(encoding="utf-8") for name in gallery()]
EYES = Camera.perspective(24, 16), Camera.panoramic(24, 8)


@contextmanager
def one_line_at_most() -> Iterator[None]:
    """Let an `ArenaError` of one line pass."""
    try:
        yield
    except ArenaError as error:
        (line,) = str(error).splitlines()
        assert line


def use(room: Arena, cell: float) -> None:
    """See it, walk in it and smell it, with odour cells of this width (m)."""
    assert Arena.parse(room.to_toml()) == room
    assert np.isfinite(room.bounds).all()
    pose = 0.0, 0.0, 1.0
    with one_line_at_most():
        x, y = room.sample_free(1, 0.18, np.random.default_rng(0))[0].tolist()
        pose = x, y, 1.0
        drive = Disc().place(room, pose)
        for _ in range(5):
            drive.step(0.6, 1.0, 0.1)
    for eye in EYES:
        assert eye.render(room, np.array([pose])).any()
    with one_line_at_most():
        odours = dataclasses.replace(room.odours, cell=cell)
        assert (odours.concentration(np.array([pose[:2]])) > 0).all()


def survive(seeds: range, folder: Path, cell: float = 0.05) -> int:
    """Load a mutant for every seed, and use it if it is valid; how many are."""
    file, valid = folder / "mutant.toml", 0
    for seed in seeds:
        rng = np.random.default_rng(seed)
        raw = mutate(TEXTS[rng.integers(len(TEXTS))], rng)
        file.write_bytes(raw)
        try:
            with one_line_at_most():
                room = Arena.load(file)
                valid += 1
                use(room, cell)
        except Exception as error:
            error.add_note(f"seed {seed}:\n{raw.decode(errors='replace')}")
            raise
    return valid


def test_three_hundred_mutants(tmp_path: Path) -> None:
    assert 60 < survive(range(300), tmp_path, cell=0.2) < 240


@pytest.mark.full
def test_ten_thousand_mutants(tmp_path: Path) -> None:
    assert 2000 < survive(range(1000, 11_000), tmp_path) < 8000
