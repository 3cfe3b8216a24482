"""Recorded views per second, against rendering alone."""

import shutil
import tempfile
from pathlib import Path

from arena import Brownian, Camera, explore
from benchmarks.timing import ROOM, Figures, one_core, poses, versus

VIEWS = 17_000
ROUNDS = 5


def exploring() -> Figures:
    """Record 17,000 panoramas of a Brownian walk with smells, views per second, on one core and on all.

    Views are kept in memory or written to disk, in turn with painting alone at as many poses.
    """
    with one_core():
        alone = measured()
    return {"one_core": alone, "all_cores": measured()}


def measured() -> Figures:
    """Walk, look, smell and keep, over looking alone at the same poses."""
    camera, where = Camera.panoramic(), poses(VIEWS)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "views.zarr"

        def render() -> int:
            for first in range(0, VIEWS, 256):
                camera.render(ROOM, where[first : first + 256])
            return VIEWS

        def keep() -> int:
            return len(explore(ROOM, Brownian(), camera, views=VIEWS))

        def write() -> int:
            shutil.rmtree(path, ignore_errors=True)
            return len(explore(ROOM, Brownian(), camera, views=VIEWS, out=path))

        return {
            "memory": versus(keep, render, ROUNDS, beside="painting alone"),
            "disk": versus(write, render, ROUNDS, beside="painting alone"),
        }
