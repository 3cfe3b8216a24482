"""Where an experiment takes place, and how much of it there is."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from tempfile import mkdtemp

import numpy as np
from jaxtyping import Float

from arena import Arena, Body, Camera, Motion, Recording, explore

FRESH = 5000
"""Views of a fresh walk, or as many as were learnt from when these are fewer."""
FRESH_SEED = 1000
"""Added to the seed for a fresh walk, on which what was learnt is scored."""
_BODY = Body()


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
    scratch: Path | None = None
    """Folder to keep views in while the experiment lasts; in memory when None."""

    def explore(
        self,
        motion: Motion,
        camera: Camera,
        *,
        body: Body = _BODY,
        views: int | None = None,
        fresh: bool = False,
    ) -> Recording:
        """Walk through the room; the same walk whatever the camera."""
        return explore(
            self.room,
            motion,
            camera,
            body=body,
            views=self.views if views is None else views,
            seed=self.seed + FRESH_SEED * fresh,
            out=None if self.scratch is None else Path(mkdtemp(dir=self.scratch)) / "walk.zarr",
            progress=self.progress,
        )


def poses_of(recording: Recording) -> Float[np.ndarray, "views 3"]:
    """Ground truth, which `explore` always records."""
    if recording.poses is None:
        raise ValueError("a fresh recording has poses")
    return recording.poses
