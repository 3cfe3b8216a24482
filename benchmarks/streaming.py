"""How learning from a stream goes on: memory and time per view, whatever came before."""

import resource
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from arena import Brownian, Camera, Recording, explore
from benchmarks.timing import ROOM, Figures
from cogmap import CognitiveMap
from neurons.stages import STAGES

VIEWS = 200_000
WALKED = 17_000
PIECE = 1000
"""Views of a walk that are handed over at once."""
EPOCHS = 20
"""Of the stream: all stages are passed, and the last one lasts for six of them."""


def streaming(views: int = VIEWS) -> Figures:
    """Stream pieces of a walk, in an order of their own, in a process that does nothing else.

    Views lie on disk, so that `peak_over_before_bytes` is what learning takes, the piece included;
    `late_over_early` is the median time of a piece in the last tenth of the stream over that in the first
    tenth's worth of the same stage.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "walk.zarr"
        explore(ROOM, Brownian(), Camera.panoramic(), views=min(views, WALKED), seed=0, out=path)
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as alone:
            return alone.submit(learn, path, views).result()


def learn(path: Path, views: int) -> Figures:
    """Learn from so many views, piece by piece, each followed by another from elsewhere."""
    walk = Recording.open(path)
    starts = np.arange(0, len(walk) - PIECE + 1, PIECE)
    rng = np.random.default_rng(0)
    cmap = CognitiveMap(epoch=views // EPOCHS)
    before, peaks, spent = peak(), [], []
    for _ in range(views // PIECE):
        start = rng.choice(starts)
        piece = walk.views[start : start + PIECE]
        started = time.perf_counter()
        cmap.partial_fit(piece, walk.odours[start : start + PIECE], jump=True)
        spent.append(time.perf_counter() - started)
        peaks.append(peak())
    tenth, begun = len(spent) // 10, cmap._network.begins(STAGES[-1].name) // PIECE  # noqa: SLF001
    return {
        "views": len(spent) * PIECE,
        "views_per_s": len(spent) * PIECE / sum(spent),
        "peak_over_before_bytes": peaks[-1] - before,
        "peak_risen_in_last_tenth_bytes": peaks[-1] - peaks[-tenth - 1],
        "late_over_early": float(np.median(spent[-tenth:]) / np.median(spent[begun : begun + tenth])),
    }


def peak() -> int:
    """Largest resident memory of this process so far, bytes."""
    found = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return found if sys.platform == "darwin" else 1024 * found
