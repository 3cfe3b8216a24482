"""`make verify`: a million views of 64 explorers in one map; Dask workers of which one is killed half way."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest

from arena import Arena, Brownian, Camera, Disc, Nose, explore
from cogmap import Activity, CognitiveMap, score
from cogmap.growing.expedition import Expedition
from tests import clusters
from tests.forked import Forked, prepare

pytestmark = pytest.mark.full

ROOT = Path(__file__).parents[2]
VIEWS, EXPLORERS = 1_000_000, 64
BARS = [
    ("trusted", "=", True),
    ("decoded_from_17000/position_median_m", "≤", 0.012),
    ("decoded_from_100000/position_median_m", "≤", 0.01),
    ("decoded_from_17000/heading_median_deg", "≤", 0.4),
    ("decoded_from_17000/metric_map_median_m", "≤", 0.01),
    ("seconds", "≤", 480),
    ("peak_bytes", "≤", 2 * 10**9),
    ("peak_over_before_bytes", "≤", 10**9),
]


def measure(folder: Path, room: str = "furnished", seed: int = 0, views: int = VIEWS) -> dict[str, Any]:
    """Grow a map by a command of its own; tell time, memory and how well it tells poses of a fresh walk."""
    command = [sys.executable, "-m", "cogmap", "grow", room, "--out", folder / "map", "--json"]
    sizes = ["--explorers", str(EXPLORERS), "--views", str(views), "--seed", str(seed)]
    started, peak = time.perf_counter(), 0
    with subprocess.Popen([*command, *sizes], cwd=ROOT, stdout=subprocess.PIPE, text=True) as process:
        while process.poll() is None:
            peak = max(peak, memory(psutil.Process(process.pid)))
            time.sleep(2)  # to count memory takes time of its own
        seconds = time.perf_counter() - started
        assert process.stdout is not None
        told = json.loads(process.stdout.read())
    figures = {"seconds": seconds, "by_stage": told["seconds"], "charts": told["charts"]}
    figures |= {"trusted": told["trusted"], "peak_bytes": peak, "peak_over_before_bytes": peak - imported()}
    return {**figures, **scored(folder / "map", room, seed, views)}


def imported() -> int:
    """Count what a process holds that has imported what it needs, and done nothing."""
    said = "import psutil, cogmap.growing.growing; print(psutil.Process().memory_full_info().pss)"
    run = subprocess.run([sys.executable, "-c", said], cwd=ROOT, capture_output=True, text=True, check=True)
    return int(run.stdout)


def memory(process: psutil.Process) -> int:
    """Sum up what a command and its processes hold: what they share is shared out among them."""
    held = 0
    for one in (process, *process.children(recursive=True)):
        try:
            held += one.memory_full_info().pss
        except psutil.Error:
            continue
    return held


def scored(path: Path, room: str, seed: int, views: int) -> dict[str, Any]:
    """Score a map on 5,000 views of a fresh walk; decoders know 17,000 and 100,000 of those it has learnt."""
    cmap, arena = CognitiveMap.load(path), Arena.load(room)
    fresh = explore(arena, Brownian(), Camera.panoramic(), views=5000, seed=seed + 1000)
    assert fresh.poses is not None
    seen = cmap.perceive(fresh.views)
    camera = Camera.panoramic()
    told = (Brownian(), camera, Nose(), Disc(), EXPLORERS, views, seed)
    expedition = Expedition(arena.to_toml(), *told)
    poses = np.concatenate([expedition.walk(explorer).poses for explorer in range(EXPLORERS)])
    poses = poses[np.random.default_rng(seed).permutation(len(poses))[:100_000]]
    known = [cmap.perceive(camera.render(arena, part)) for part in np.split(poses, 100)]
    activity = Activity(*(np.concatenate([getattr(one, name) for one in known]) for name in NAMES))
    figures = {}
    for count in (17_000, 100_000):
        train = activity[:count], poses[:count]
        figures[f"decoded_from_{count}"] = score(seen, np.asarray(fresh.poses), train=train)
    return figures


NAMES = ("place", "heading", "phase", "odour", "position")


def test_a_million_views(judge: Callable[..., None], tmp_path: Path) -> None:
    figures = measure(tmp_path)
    sys.stdout.write(json.dumps(figures, indent=2) + "\n")
    judge("furnished, a million views", figures, BARS)


def test_a_worker_that_is_killed_half_way_changes_nothing(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1"}
    prepare(("cogmap.commands.growing", *clusters.NEEDED), **environment)
    small = ["--views", 60_000, "--charts", 1500, "--epoch", 10_000, "--width", 90, "--height", 15]

    def start(name: str, *words: object) -> Forked:
        command = ["grow", "furnished", "--out", tmp_path / name, *small, *words]
        return Forked("cogmap.cli:main", command, environment, tmp_path / f"said-{name}")

    alone = start("alone", "--threads", 1)
    _, err = alone.communicate(timeout=1200)
    assert alone.poll() == 0, err
    with clusters.cluster(tmp_path, environment, workers=2) as (address, processes):
        growing = start("shared", "--scheduler", address)
        place = tmp_path / "shared.growing" / "now" / "place.json"
        while not (place.exists() and "olfaction" in place.read_text("utf-8")) and growing.poll() is None:
            time.sleep(0.05)
        time.sleep(0.5)
        assert growing.poll() is None, growing.communicate()
        processes[1].kill()
        _, err = growing.communicate(timeout=1200)
    assert growing.poll() == 0, err
    alike = [(tmp_path / name / "weights.safetensors").read_bytes() for name in ("alone", "shared")]
    assert alike[0] == alike[1]


if __name__ == "__main__":
    out = Path(sys.argv[1])
    out.mkdir(parents=True)
    sys.stdout.write(json.dumps(measure(out, *sys.argv[2:]), indent=2) + "\n")
