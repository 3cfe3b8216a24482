"""How cost grows: seconds of the same work at sizes that double, and the exponent of the power law."""

import time
import warnings
from collections.abc import Callable, Sequence

import numpy as np
import torch

from arena import Arena, Brownian, Camera, explore
from benchmarks.evaluating import grown
from benchmarks.rendering import painting
from benchmarks.stepping import explorers
from benchmarks.timing import ROOM, Figures, one_core, poses
from cogmap import CognitiveMap, UntrustedMapWarning
from cogmap.threads import one_thread
from neurons.layers.heading_cells import HeadDirectionCells

FACES = (8, 16, 32, 64, 128, 256, 512, 800)
VIEWS = (500, 1000, 2000, 4000, 8000)
CHARTS = (250, 500, 1000, 2000, 4000)
CELLS = (125, 250, 500, 1000, 2000, 4000)
EXPLORERS = (1, 4, 16, 64, 256, 1024)
POSITIONS = 2000
SOME = 4000
PANORAMIC = Camera.panoramic()


def scaling() -> Figures:
    """Do the same work at more and more, on one core, and fit its seconds by a power of the size.

    200 panoramas of 360×60 pixels are painted of a hall with more and more boxes. Views of 90×15 pixels are
    learnt and perceived by a map of 250 charts, and 4,000 of them by maps of more and more. Cells are
    evaluated at 2,000 places and headings, and explorers step once together. Seconds are those of the core,
    whatever else it does, the least of a few runs. An exponent below 1 means that a part of the cost is
    always the same, one above it that memory leaves the caches; its error is the standard error of the fit.
    """
    with one_core(), one_thread(), warnings.catch_warnings():
        # charts of so few views need not agree, which changes no cost
        warnings.simplefilter("ignore", UntrustedMapWarning)
        return {
            "painting_by_surfaces": growth(FACES, lambda n: spent(painting(PANORAMIC, hall(n)))),
            **mapping(),
            "place_cells_by_cells": growth(CELLS, lambda n: spent(place_cells(n))),
            "heading_cells_by_cells": growth(CELLS, lambda n: spent(heading_cells(n))),
            "stepping_by_explorers": growth(EXPLORERS, lambda n: spent(explorers(n))),
        }


def mapping() -> Figures:
    """Learn and perceive more and more views, and with more and more charts."""
    walk = explore(ROOM, Brownian(), Camera.panoramic(90, 15), views=max(VIEWS), seed=0)
    views, odours = walk.views, walk.odours
    few, *_ = maps = {charts: CognitiveMap(charts=charts) for charts in CHARTS}

    def learn(charts: int, count: int) -> float:
        return spent(lambda: maps[charts].fit(views[:count], odours[:count]), 1)

    def perceive(charts: int, count: int) -> float:
        return spent(lambda: maps[charts].perceive(views[:count]))

    return {
        "learning_by_views": growth(VIEWS, lambda n: learn(few, n)),
        "perceiving_by_views": growth(VIEWS, lambda n: perceive(few, n)),
        "learning_by_charts": growth(CHARTS, lambda n: learn(n, SOME)),
        "perceiving_by_charts": growth(CHARTS, lambda n: perceive(n, SOME)),
    }


def place_cells(cells: int) -> Callable[[], object]:
    """Give work that evaluates place cells at what is smelt."""
    smelling, layer = grown(poses(POSITIONS)[:, :2], cells)
    smelt = smelling()
    return lambda: layer(smelt)


def heading_cells(cells: int) -> Callable[[], object]:
    """Give work that evaluates head-direction cells."""
    headings = torch.from_numpy(poses(POSITIONS)[:, 2]).float()
    layer = HeadDirectionCells(cells, 1, generator=torch.Generator().manual_seed(0))
    return lambda: layer.tuning(headings)


def hall(faces: int) -> Arena:
    """Furnish a hall of 12 m × 12 m with rows of boxes until it has so many faces."""
    corners = [(-6.0, -6.0), (6.0, -6.0), (6.0, 6.0), (-6.0, 6.0)]
    ends = zip(corners, corners[1:] + corners[:1], strict=True)
    boxes = faces // 4 - 1
    places = np.stack(np.meshgrid(*[np.linspace(-5.2, 5.2, 15)] * 2), axis=-1).reshape(-1, 2)
    chosen = places[np.linspace(0, len(places) - 1, boxes).astype(int)]
    return Arena.create(
        name="hall",
        platform=[corners],
        walls=[{"start": start, "end": end, "material": "brick"} for start, end in ends],
        boxes=[
            {"center": center, "size": (0.2, 0.2), "height": 0.6, "material": "oak"}
            for center in chosen.tolist()
        ],
    )


def spent(work: Callable[[], object], repeats: int = 7) -> float:
    """Seconds of this process, the least of a few runs, after one to warm up."""
    work()
    taken = []
    for _ in range(repeats):
        started = time.process_time()
        work()
        taken.append(time.process_time() - started)
    return min(taken)


def growth(sizes: Sequence[int], cost: Callable[[int], float]) -> Figures:
    """Fit the cost (s) of sizes by a power of them.

    The exponent is the slope of log seconds on log size by least squares, with its standard error.
    """
    costs = [cost(size) for size in sizes]
    (slope, _), spread = np.polyfit(np.log(sizes), np.log(costs), 1, cov=True)
    return {
        "sizes": list(sizes),
        "seconds": costs,
        "exponent": float(slope),
        "exponent_error": float(np.sqrt(spread[0, 0])),
    }
