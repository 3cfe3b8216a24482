"""Explores, goes on with a recording, learns and sweeps; prints digests of all that comes of it.

    python -m tests.portable_program FOLDER VIEWS CHARTS

In FOLDER/begun.zarr there may be a recording that another process has begun.
"""

import hashlib
import json
import sys
from pathlib import Path

import numpy as np

from arena import Arena, Brownian, Camera, Chemotaxis, Recording, explore
from cogmap import CognitiveMap, Plan, sweep
from cogmap.features import vocabulary
from cogmap.portable import arithmetic


def digest(*arrays: np.ndarray) -> str:
    found = hashlib.sha256()
    for array in arrays:
        found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()[:16]


def of(recording: Recording) -> str:
    return digest(recording.views[:], recording.odours, recording.times, recording.poses)


def run(folder: Path, views: int, charts: int) -> dict[str, str]:
    room, camera = Arena.load("furnished"), Camera.panoramic(90, 15)
    walk = explore(room, Brownian(), camera, views=views, seed=0, out=folder / "begun.zarr")
    climb = explore(room, Chemotaxis(), camera, views=300, seed=0)
    cmap = CognitiveMap(charts=charts, components=20, place_cells=40).fit(walk.views, walk.odours)
    cmap.save(folder / "map")

    # SIFT in views and k-means of descriptors as many as usual would take most of the time
    vocabulary.EXAMPLES, look = 2000, Camera.perspective
    Camera.perspective = lambda: look(160, 120)
    plan = Plan.create(experiment="rotation", views=200, seeds=[0], grid={"arena": ["pillar"]})
    sweep(plan, folder / "swept", workers=1)
    return {
        "arithmetic": arithmetic(),
        "recording": of(walk),
        "climb": of(climb),
        "codes": digest(cmap.encode(walk.views[:])),
        "map": hashlib.sha256((folder / "map" / "weights.safetensors").read_bytes()).hexdigest()[:16],
        "table": hashlib.sha256((folder / "swept" / "table.csv").read_bytes()).hexdigest()[:16],
    }


if __name__ == "__main__":
    sys.stdout.write(json.dumps(run(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]))) + "\n")
