"""How much of two processes a sweep puts to use, on points of two seconds and more."""

import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.timing import Figures
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.registry import experiment
from cogmap.experiments.result import Result
from cogmap.sweeps import Plan, sweep

SECONDS, WORKERS, POINTS = 2.0, 2, 48
NOISES = np.linspace(0.05, 0.3, 24).tolist()


@experiment(room="furnished", views=200)
def waiting(conditions: Conditions) -> Result:
    """Take two seconds and nothing of the machine."""
    time.sleep(SECONDS)
    return Result({"seed": conditions.seed})


@experiment(room="furnished", views=200)
def computing(conditions: Conditions) -> Result:
    """Take two seconds of one core."""
    started = time.thread_time()
    while time.thread_time() < started + SECONDS:
        pass
    return Result({"seed": conditions.seed})


def sweeping() -> Figures:
    """Measure the share of the least possible time, start of the processes included.

    Points that wait tell what the sweep itself costs; points that compute also what the machine's other work
    does, so that the load stands beside them. Fusions are the real thing: here the least possible time is
    half of what one worker takes for the same points, and the two share the machine's memory.
    """
    figures: Figures = {"workers": WORKERS, "points": POINTS, "seconds_a_point": SECONDS}
    for conduct in (waiting, computing):
        plan = Plan.create(experiment=conduct.__name__, grid={"views": list(range(200, 200 + POINTS))})
        figures[f"efficiency_{conduct.__name__}"] = POINTS * SECONDS / WORKERS / spent(plan, WORKERS)
    fusions = Plan.create(
        experiment="fusion", views=3000, set={"map.charts": 800}, grid={"nose.noise": NOISES}
    )
    alone = spent(fusions, 1)
    figures["seconds_a_fusion"] = alone / len(NOISES)
    figures["efficiency_fusion"] = alone / WORKERS / spent(fusions, WORKERS)
    return figures


def spent(plan: Plan, workers: int) -> float:
    """Seconds that a sweep takes from nothing to its table."""
    with TemporaryDirectory() as folder:
        started = time.perf_counter()
        sweep(plan, Path(folder) / "swept", workers=workers)
        return time.perf_counter() - started
