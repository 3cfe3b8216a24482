"""Where an experiment takes place, and how much of it there is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from arena import Arena, Camera, Motion, Recording, explore

FRESH_SEED = 1000
"""Added to the seed for a fresh walk, on which what was learnt is scored."""


@dataclass(frozen=True)
class Setting:
    """What every experiment is told."""

    room: Arena
    views: int
    """To learn from."""
    seed: int = 0
    """Of walks, noise and all that is drawn."""
    progress: bool = False
    """Whether to show progress on stderr."""

    def explore(
        self, motion: Motion, camera: Camera, *, views: int | None = None, fresh: bool = False
    ) -> Recording:
        """Walk through the room; the same walk whatever the camera."""
        return explore(
            self.room,
            motion,
            camera,
            views=self.views if views is None else views,
            seed=self.seed + FRESH_SEED * fresh,
            progress=self.progress,
        )


def poses_of(recording: Recording) -> Float[np.ndarray, "views 3"]:
    """Ground truth, which `explore` always records."""
    if recording.poses is None:
        raise ValueError("a fresh recording has poses")
    return recording.poses
