from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest

from arena import Camera
from cogmap import CognitiveMap, grow
from cogmap.growing.work import Outcome, Task, do

SMALL: dict[str, Any] = {
    "explorers": 5, "views": 803, "charts": 60, "epoch": 400, "components": 10, "place_cells": 12,
    "heading_cells": 8, "camera": Camera.panoramic(90, 15), "threads": 1,
}  # fmt: skip
"""A map of few charts, which tells nobody where it is."""


def weights(path: Path) -> bytes:
    return (path / "weights.safetensors").read_bytes()


def grown(out: Path, **changed: Any) -> CognitiveMap:
    return grow("furnished", out, **{**SMALL, **changed})


def backwards(tasks: Iterable[Task]) -> Iterator[Outcome]:
    """A crew in which those are done first that were begun last."""
    yield from [do(task) for task in tasks][::-1]


@pytest.fixture(scope="session")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where a map is that nothing has disturbed."""
    out: Path = tmp_path_factory.mktemp("grown") / "map"
    grown(out)
    return out


Crew = Callable[[Iterable[Task]], Iterator[Outcome]]
