from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from arena import Arena, Camera
from arena.angles import wrap_angle
from cogmap import CognitiveMap
from cogmap.imagination import Imagination
from cogmap.map.activity import Activity

SCALE, NORTH = 2.0, 0.7


class Seer(CognitiveMap):
    """A map that knows where each of its views was taken, in a frame of its own, mirrored or not."""

    def begin(self, views: np.ndarray, poses: np.ndarray, *, mirrored: bool) -> Seer:
        self.view_shape_ = views.shape[1:]
        self.mirrored = mirrored
        self.relaxed_places_: Any = SimpleNamespace(mirrored_=mirrored)
        self.refine_reason_ = "told so"
        self.poses = {view.tobytes(): pose for view, pose in zip(views, poses, strict=True)}
        self.novelty, self.compass = 1.0, True
        return self

    def framed(self, poses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        z = poses[:, 0] + 1j * poses[:, 1]
        phase = poses[:, 2] + NORTH
        z = SCALE * np.exp(1j * NORTH) * z
        if self.mirrored:
            z, phase = z.conj(), -phase
        return np.column_stack([z.real, z.imag]), wrap_angle(phase)

    def perceive(self, views: Any = None, *, odours: Any = None) -> Activity:
        assert odours is None
        position, phase = self.framed(np.stack([self.poses[view.tobytes()] for view in views]))
        none = np.zeros((len(phase), 1), np.float32)
        if not self.compass:
            phase = np.full_like(phase, np.nan)
        return Activity(
            none,
            none,
            phase.astype(np.float32),
            none,
            position.astype(np.float32),
            novelty=np.full(len(phase), self.novelty, np.float32),
        )


@pytest.fixture(scope="session")
def room() -> Arena:
    return Arena.load("furnished")


@pytest.fixture(scope="session")
def remembered(room: Arena, camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """Views and poses on a jittered grid of a square metre, and ten more in between."""
    rng = np.random.default_rng(0)
    x, y = np.meshgrid(np.arange(-0.5, 0.5, 0.05), np.arange(-0.5, 0.5, 0.05))
    places = np.column_stack([x.ravel(), y.ravel()]) + rng.uniform(-0.015, 0.015, (x.size, 2))
    poses = np.column_stack([places, rng.uniform(-np.pi, np.pi, len(places))])
    asked = np.column_stack([rng.uniform(-0.4, 0.35, (10, 2)), rng.uniform(-np.pi, np.pi, 10)])
    poses = np.concatenate([poses, asked])
    return camera.render(room, poses), poses


@pytest.fixture(scope="session", params=[False, True], ids=["plain", "mirrored"])
def dream(request: pytest.FixtureRequest, remembered: tuple[np.ndarray, np.ndarray]) -> Imagination:
    views, poses = remembered
    seer = Seer().begin(views, poses, mirrored=request.param)
    return Imagination(seer, memory=views[:-10])


@pytest.fixture(scope="session")
def asked(remembered: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Views that are not remembered."""
    return remembered[0][-10:]
