"""How learning from a stream goes on: memory and time per view, whatever came before.

`python -m benchmarks.streaming 100000` streams so many views instead of a million.
"""

import json
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from itertools import product
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from arena import Brownian, Camera, Disc, Nose
from benchmarks.timing import ROOM, Figures
from cogmap import CognitiveMap
from neurons.stages import STAGES

VIEWS = 1_000_000
EXPLORERS = 64
PIECE = 3125
"""Views of an explorer that are learnt in a row, a fifth of its walk."""
EPOCHS = 20
"""Of the stream: all stages are passed, and the last one lasts for six of them."""


class Painted:
    """Views from poses, painted when they are asked for and kept nowhere."""

    dtype = np.dtype(np.uint8)

    def __init__(self, poses: np.ndarray) -> None:
        self._poses, self._camera = poses, Camera.panoramic()
        self.shape = (len(poses), self._camera.height, self._camera.width, 3)

    def __getitem__(self, rows: slice) -> np.ndarray:
        return self._camera.render(ROOM, self._poses[rows])


def streaming(views: int = VIEWS) -> Figures:
    """Learn what 64 explorers see, piece by piece, in a process that does nothing else.

    `seconds` are of walking, painting and learning. `peak_over_before_bytes` is what painting and learning
    take, batches included, beside `views_bytes`, which all views at once would; `late_over_early` is the
    median time of a piece in the last tenth of the stream over that in the first tenth's worth of the same
    stage.
    """
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as alone:
        return alone.submit(learn, views).result()


def learn(views: int) -> Figures:
    """Learn from so many views, each piece followed by one of another explorer."""
    Painted(np.zeros((4, 3)))[:]  # compiles
    started = time.perf_counter()
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as walkers:
        walks = list(walkers.map(partial(walk, views // EXPLORERS), range(EXPLORERS)))
    walked = time.perf_counter() - started
    cmap = CognitiveMap(epoch=views // EPOCHS)
    before, peaks, spent, last = peak(), [], [], 0
    for first, (poses, odours) in product(range(0, views // EXPLORERS, PIECE), walks):
        piece = slice(first, first + PIECE)
        begun = time.perf_counter()
        cmap.partial_fit(Painted(poses[piece]), odours[piece], jump=True)
        spent.append((time.perf_counter() - begun) / len(poses[piece]))
        peaks.append(peak())
        last += cmap._rooms[0].stage != STAGES[-1]  # noqa: SLF001
    tenth = len(spent) // 10
    return {
        "views": int(cmap._rooms[0].views_seen),  # noqa: SLF001
        "views_bytes": views * int(np.prod(Painted(np.zeros((1, 3))).shape)),
        "seconds": time.perf_counter() - started,
        "seconds_walking": walked,
        "peak_bytes": peaks[-1],
        "peak_over_before_bytes": peaks[-1] - before,
        "peak_risen_in_last_tenth_bytes": peaks[-1] - peaks[-tenth - 1],
        "late_over_early": float(np.median(spent[-tenth:]) / np.median(spent[last + 1 :][:tenth])),
        "untrusted_because": cmap.reason_,
    }


def walk(views: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Give the poses of one explorer and what it smells."""
    rng = np.random.default_rng(seed)
    times, poses, *_ = Brownian().walk(ROOM, Disc(), views, rng)
    return poses, Nose().smell(ROOM.odours.concentration(poses[:, :2]), times, rng)


def peak() -> int:
    """Largest resident memory of this process so far, bytes; `getrusage` would count its parent's."""
    (line,) = (line for line in Path("/proc/self/status").read_text().splitlines() if "VmHWM" in line)
    return 1024 * int(line.split()[1])


if __name__ == "__main__":
    print(json.dumps(streaming(*map(int, sys.argv[1:])), indent=2))
