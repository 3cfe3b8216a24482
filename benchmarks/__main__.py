"""`make bench`: every ratio, as JSON on stdout and as a table on stderr."""

import json
import sys
import time
from collections.abc import Callable

import numba
import numpy as np
import pymunk
import torch
from sklearn.decomposition import IncrementalPCA

from arena import Arena, Camera
from benchmarks.walking import walking
from cogmap.tables import as_table
from cogmap.threads import one_thread
from neurons.oja import Sanger
from neurons.retina import Retina

REPEATS = 3
ROOM = Arena.load("furnished")
CAMERAS = {"panoramic_360x60": Camera.panoramic(), "perspective_320x240": Camera.perspective()}


def seconds(work: Callable[[], object]) -> float:
    """Shortest of a few runs, after one to warm up."""
    work()
    times = []
    for _ in range(REPEATS):
        started = time.perf_counter()
        work()
        times.append(time.perf_counter() - started)
    return min(times)


def poses(count: int) -> np.ndarray:
    """Random poses in the room."""
    rng = np.random.default_rng(0)
    return np.column_stack([ROOM.sample_free(count, 0.18, rng), rng.uniform(-np.pi, np.pi, count)])


def rendering() -> dict[str, float]:
    """Frames per second on one core, and as a fraction of the rate at which memory copies the same images."""
    numba.set_num_threads(1)
    figures = {}
    for name, camera in CAMERAS.items():
        where = poses(500)
        images = camera.render(ROOM, where)
        drawn = seconds(lambda camera=camera, where=where: camera.render(ROOM, where))
        copied = seconds(images.copy)
        figures[f"{name}_frames_per_s"] = len(images) / drawn
        figures[f"{name}_over_memory_copy"] = copied / drawn
    return figures


def depth() -> dict[str, float]:
    """Rays per second on one core over those of pymunk's segment queries."""
    numba.set_num_threads(1)
    camera, where = Camera.panoramic(), poses(50)
    mine = seconds(lambda: camera.depth(ROOM, where))
    space = ROOM.space()
    angles = np.pi - (np.arange(camera.width) + 0.5) / camera.focal_length

    def ask() -> None:
        for x, y, heading in where:
            for angle in heading + angles:
                ends = (x + 10 * np.cos(angle), y + 10 * np.sin(angle))
                space.segment_query_first((x, y), ends, 0, pymunk.ShapeFilter())

    return {"depth_rays_over_pymunk": seconds(ask) / mine}


def code() -> dict[str, float]:
    """Time to 99 % of the variance that 60 components can capture, IncrementalPCA's over Sanger's."""
    with one_thread():
        strips = Retina(60, 360)(torch.from_numpy(Camera.panoramic().render(ROOM, poses(4000))))
        centred = strips - strips.mean(dim=0)
        best = torch.linalg.svdvals(centred)[:60].square().sum()

        def captured(weight: torch.Tensor) -> float:
            basis = torch.linalg.qr(weight.T).Q
            return float((centred @ basis).square().sum() / best)

        layer = Sanger(strips.shape[1], 60, generator=torch.Generator().manual_seed(0))
        started = time.perf_counter()
        spent = 0.0
        while captured(layer.weight) < 0.99:
            started = time.perf_counter()
            for batch in strips.split(256):
                layer.partial_fit(batch)
            spent += time.perf_counter() - started
        peer = IncrementalPCA(60)
        started, taken = time.perf_counter(), 0.0
        for batch in strips.split(256):
            started = time.perf_counter()
            peer.partial_fit(batch.numpy())
            taken += time.perf_counter() - started
            if captured(torch.from_numpy(peer.components_).float()) >= 0.99:
                break
    return {"sanger_seconds": spent, "incremental_pca_over_sanger": taken / spent}


def main() -> None:
    """Measure one after the other."""
    figures = {"walking": walking(), "rendering": rendering(), "depth": depth(), "code": code()}
    sys.stderr.write(as_table(figures) + "\n")
    sys.stdout.write(json.dumps(figures, indent=2) + "\n")


if __name__ == "__main__":
    main()
