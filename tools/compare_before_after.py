"""Regression comparison of two checkouts: the same seed must give the same figures, arrays and weights.

    python -m tools.compare_before_after OLD NEW [--python OLD_PYTHON NEW_PYTHON] [--cache FOLDER]

Runs `demo` (furnished, seed 0), every experiment and a walk in both checkouts, compares what they print and
write, bit for bit, and ends with 1 where anything differs. Seconds and memory are left out. A result is kept
in the cache under the hash of the sources that made it, so that a comparison that was stopped goes on.
"""

import argparse
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from safetensors.numpy import load_file

EXPERIMENTS = {
    "rotation": "rotation",
    "cyclic": "cyclic",
    "brownian": "brownian",
    "similarity": "similarity",
    "localisation": "localisation",
    "roadmap": "roadmap",
    "distinguishability": "distinguishability",
    "fusion": "fusion",
    "walks": "slow_features",
    "sources": "odour_ablation",
    "acuity": "acuity",
    "darkness": "darkness",
    "cue_rotation": "cue_rotation",
    "goals": "goals",
    "directionality": "directionality",
    "neurons": "development",
    "homology": "homology",
}
"""Names of experiments, before and after."""
TENSORS = {
    "age": "views_seen",
    "matured": "stage_index",
    "charts.mass": "charts.responsibility",
    "charts.placed": "charts.initialised",
    "recall.spacing": "readout.spacing",
    "recall.phases": "readout.phases",
    "recall.turning": "readout.turning",
    "recall.intercepts": "readout.intercepts",
    "recall.jacobians": "readout.jacobians",
    "place.mass": "place.responsibility",
    "place.placed": "place.initialised",
    "heading.mass": "heading.responsibility",
    "gauge.spread": "metric_map.spread",
    "gauge.ahead": "metric_map.ahead",
    "gauge.shared": "metric_map.shared",
    "gauge.counted": "metric_map.counted",
    "gauge.seen": "metric_map.seen",
    "gauge.recent": "metric_map.recent",
    "gauge.foretold": "metric_map.cross_validated_r2",
    "gauge.positions": "metric_map.positions",
    "gauge.offsets": "metric_map.offsets",
}
"""Tensors of a map that have another name than before."""
WEIGHTS = "demo/map/weights.safetensors"
WALK = """
import os, sys, arena, numpy
assert arena.__file__.startswith(os.getcwd()), f"{arena.__file__} is another checkout"
out, views = sys.argv[1], int(sys.argv[2])
room, camera, zarr = arena.Arena.load("furnished"), arena.Camera.panoramic(), f"{out}/walk.zarr"
arena.explore(room, arena.Brownian(), camera, nose=arena.Nose(noise=.1), views=views, seed=0, out=zarr)
walk = arena.Recording.open(zarr)
names = ("views", "odours", "times", "poses")
numpy.savez(f"{out}/walk.npz", **{name: numpy.asarray(getattr(walk, name)) for name in names})
"""
ELSEWHERE = re.compile(r"(^|[._])(seconds?|ms|memory|host|experiment)($|[._])")
"""Keys that tell of the machine, or the name that the experiment was asked for by."""


def sources_hash(checkout: Path) -> str:
    """Hash all that decides about a result."""
    files = sorted(path for part in ("arena", "neurons", "cogmap") for path in (checkout / part).rglob("*.*"))
    kept = [path for path in files if path.suffix in {".py", ".toml", ".json"} and path.is_file()]
    text = b"".join(str(path.relative_to(checkout)).encode() + path.read_bytes() for path in kept)
    return hashlib.sha256(text).hexdigest()[:16]


def result(checkout: Path, python: str, cache: Path, name: str, arguments: list[str]) -> Path:
    """Run something in a checkout unless it was run before; give the folder of what it wrote and said."""
    folder = cache / sources_hash(checkout) / name
    if (folder / "said.json").is_file():
        return folder
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    command = [python, *(part.replace("{out}", str(folder)) for part in arguments)]
    where = {"cwd": checkout, "env": {**os.environ, "PYTHONPATH": str(checkout)}}
    done = subprocess.run(command, check=False, capture_output=True, text=True, **where)
    last = (done.stderr.strip().splitlines() or [""])[-1]
    said = json.loads(done.stdout) if done.stdout.strip() else {}
    fresh = folder / "said.fresh"
    fresh.write_text(
        json.dumps({"metrics": said, "error": last if done.returncode else ""}), encoding="utf-8"
    )
    fresh.rename(folder / "said.json")
    return folder


def flat(value: object, name: str = "") -> Iterator[tuple[str, str]]:
    """Give each figure of nested metrics with its name, as JSON prints it, which is exact."""
    if isinstance(value, dict | list):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from flat(part, f"{name}.{key}" if name else str(key))
    elif not ELSEWHERE.search(name):
        yield name, json.dumps(value)


def metrics_that_differ(old: dict[str, Any], new: dict[str, Any]) -> list[str]:
    """Say which figures differ, and how."""
    before, after = dict(flat(old)), dict(flat(new))
    names = [name for name in {**before, **after} if before.get(name) != after.get(name)]
    return [f"{name}: {before.get(name, 'missing')} → {after.get(name, 'missing')}" for name in names]


def compare_arrays(
    old: dict[str, np.ndarray], new: dict[str, np.ndarray], renamed: dict[str, str]
) -> Iterator[tuple[str, list[str]]]:
    """Give every array with its names before and after, and what differs: to the bit, in type or in shape."""
    pairs = {name: renamed.get(name, name) for name in old}
    for name, there in pairs.items():
        apart = ["missing"] if there not in new else [] if same(old[name], new[there]) else ["differs"]
        yield f"{name} → {there} {old[name].dtype}{old[name].shape}", apart
    yield from ((f"→ {name}", ["was not there"]) for name in new if name not in pairs.values())


def same(old: np.ndarray, new: np.ndarray) -> bool:
    """Compare bits, so that NaN equals NaN."""
    return old.dtype == new.dtype and old.shape == new.shape and old.tobytes() == new.tobytes()


def compare(name: str, old: Path, new: Path) -> Iterator[tuple[str, list[str]]]:
    """Give all that a job said and left, and the differences."""
    before, after = (json.loads((folder / "said.json").read_text(encoding="utf-8")) for folder in (old, new))
    apart = metrics_that_differ(before["metrics"], after["metrics"])
    if before["error"] != after["error"]:
        apart.append(f"error: {before['error'] or 'none'} → {after['error'] or 'none'}")
    # The program's own sentences may be equal; a crash says nothing about either checkout.
    apart += [
        "crashed" for side in (before, after) if side["error"] and not side["error"].startswith("cogmap: ")
    ]
    count = len(dict(flat(after["metrics"])))
    yield f"{name}: {after['error'] or f'{count} figures'}", apart
    for file, load in (("walk.npz", lambda path: dict(np.load(path))), (WEIGHTS, load_file)):
        if (old / file).is_file() and (new / file).is_file():
            for what, differences in compare_arrays(load(old / file), load(new / file), TENSORS):
                yield f"{file}: {what}", differences


def jobs(views: int, demo_views: int) -> dict[str, tuple[list[str], list[str]]]:
    """Give each job's arguments of Python, before and after."""
    demo = f"-m cogmap demo --arena furnished --seed 0 --views {demo_views} --out {{out}}/demo --json".split()
    walk = ["-c", WALK, "{out}", str(views)]
    tasks = {"demo": (demo, demo), "walk": (walk, walk)}
    for names in EXPERIMENTS.items():
        old, new = (
            f"-m cogmap experiment {name} --views {views} --seed 0 --out {{out}}/result --json".split()
            for name in names
        )
        tasks[names[1]] = old, new
    return tasks


def main() -> int:
    """Compare, print a line for everything, and tell whether all is equal."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("checkouts", nargs=2, type=Path, metavar="CHECKOUT", help="before and after")
    parser.add_argument("--python", nargs=2, default=[sys.executable] * 2, help="of each checkout")
    parser.add_argument("--cache", type=Path, default=Path(".compared"), help="folder for results")
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--views", type=int, default=600, help="of the walk and every experiment")
    parser.add_argument("--demo-views", type=int, default=6000)
    parser.add_argument("--only", nargs="*", help="names of jobs: demo, walk, experiments by their new names")
    given = parser.parse_args()
    every = jobs(given.views, given.demo_views)
    chosen = {name: every[name] for name in given.only or every}
    counts = f"{given.views}-{given.demo_views}"

    def both(name: str) -> list[tuple[str, list[str]]]:
        sides = zip(given.checkouts, given.python, chosen[name], strict=True)
        old, new = (
            result(checkout.resolve(), python, given.cache.resolve(), f"{counts}-{name}", arguments)
            for checkout, python, arguments in sides
        )
        return list(compare(name, old, new))

    equal = True
    with ThreadPoolExecutor(given.workers) as pool:
        for parts in pool.map(both, chosen):
            for what, differences in parts:
                equal &= not differences
                verdict = "not equal" if differences else "equal"
                print(f"{verdict:10}{what}", *differences, sep="\n              ", flush=True)
    return not equal


if __name__ == "__main__":
    sys.exit(main())
