"""Speed and memory of the manifold, against SIFT itself and Isomap."""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np
import scipy.sparse as sp
from joblib import cpu_count
from scipy.sparse.csgraph import dijkstra
from scipy.spatial.distance import cdist

from arena import Arena, Brownian, Camera, explore
from benchmarks.timing import Figures
from cogmap.features import BagOfWords
from cogmap.graph import neighbour_graph
from cogmap.threads import one_thread

VIEWS = 17_000
TIMED = 500
"""Views on which SIFT alone is timed, spread over all."""
SOURCES = 300
"""Points from which geodesics are measured."""
COMPONENTS = 4
FIT = """
import json, time
from pathlib import Path
import numpy as np, scipy.sparse as sp
{imports}
words = sp.csr_array(sp.load_npz({path!r}))
model = {model}
model.fit(words[:200])
started = time.perf_counter()
embedding = model.fit_transform(words)
seconds = time.perf_counter() - started
np.save({path!r} + ".npy", embedding)
peak = Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0]
print(json.dumps([seconds, 1024 * int(peak)]))
"""
"""Fits in a process of its own and tells its peak of memory, program and all (Linux; `getrusage` would tell
that of its parent); a small fit comes first, which loads what loads late."""
MODELS = {
    "landmark": (
        "from cogmap.shape import LandmarkIsomap",
        f"LandmarkIsomap({COMPONENTS}, metric='cosine')",
    ),
    "sklearn": (
        "from sklearn.manifold import Isomap",
        f"Isomap(n_neighbors=15, n_components={COMPONENTS}, n_jobs=-1)",
    ),
}


def bag_of_words(views: np.ndarray) -> tuple[Figures, sp.csr_array]:
    """Time to learn and give the words of views, over that of SIFT on one thread divided by the cores."""
    some = views[:: max(1, len(views) // TIMED)]
    sift = cv2.SIFT_create()

    def alone() -> float:
        started = time.perf_counter()
        with one_thread():
            for view in some:
                sift.detectAndCompute(cv2.cvtColor(view, cv2.COLOR_RGB2GRAY), None)
        return (time.perf_counter() - started) / len(some)

    BagOfWords(10, 10).fit(views[:128])
    before, started = alone(), time.perf_counter()
    words = BagOfWords(progress=sys.stderr.isatty()).fit_transform(views)
    spent = time.perf_counter() - started
    # What else runs on the machine slows both; SIFT is timed on either side.
    each = (before + alone()) / 2
    return {
        "bag_of_words_seconds": spent,
        "sift_ms_per_view": 1e3 * each,
        "bag_of_words_over_sift_per_core": spent / (each * len(views) / cpu_count()),
    }, words


def landmark_isomap(words: sp.csr_array) -> Figures:
    """Speed, memory and geodesic correlation of landmark Isomap beside those of scikit-learn's Isomap."""
    graph = neighbour_graph(words, metric="cosine")
    sources = np.random.default_rng(0).choice(len(words.indptr) - 1, SOURCES, replace=False)
    paths = dijkstra(graph, indices=sources)
    seconds, memory, correlation = {}, {}, {}
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "words.npz")
        sp.save_npz(path, words)
        for name, (imports, model) in MODELS.items():
            script = FIT.format(imports=imports, model=model, path=path)
            command = [sys.executable, "-c", script]
            run = subprocess.run(command, check=True, capture_output=True, text=True)  # noqa: S603
            seconds[name], memory[name] = json.loads(run.stdout)
            embedding = np.load(f"{path}.npy")
            apart = cdist(embedding[sources], embedding)
            correlation[name] = float(np.corrcoef(paths.ravel(), apart.ravel())[0, 1])
    return {
        **{f"isomap_{name}_seconds": value for name, value in seconds.items()},
        **{f"isomap_{name}_bytes": float(value) for name, value in memory.items()},
        **{f"isomap_{name}_correlation": value for name, value in correlation.items()},
        "isomap_speed_over_sklearn": seconds["sklearn"] / seconds["landmark"],
        "isomap_memory_over_sklearn": memory["landmark"] / memory["sklearn"],
        "isomap_correlation_below_sklearn": correlation["sklearn"] - correlation["landmark"],
    }


def manifold() -> Figures:
    """Find the manifold of 17,000 perspective views of `furnished`, each once.

    Words are learnt and counted on all cores, beside SIFT alone on one thread divided by the cores. Landmark
    Isomap of the words is fitted in a process of its own, beside scikit-learn's Isomap: seconds, peak of
    memory, and how well distances correlate with the lengths of shortest paths.
    """
    room = Arena.load("furnished")
    walk = explore(room, Brownian(), Camera.perspective(), views=VIEWS)
    figures, words = bag_of_words(np.asarray(walk.views))
    return {**figures, **landmark_isomap(words)}
