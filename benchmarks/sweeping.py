"""How much of two processes a sweep puts to use, on points of two seconds each."""

import time
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.timing import Figures
from cogmap.experiments.catalogue import EXPERIMENTS, Experiment
from cogmap.experiments.result import Result
from cogmap.experiments.setting import Setting
from cogmap.sweeps import Plan, sweep

SECONDS, WORKERS, POINTS = 2.0, 2, 48


def waiting(setting: Setting) -> Result:
    """Take two seconds and nothing of the machine."""
    time.sleep(SECONDS)
    return Result({"seed": setting.seed})


def computing(setting: Setting) -> Result:
    """Take two seconds of one core."""
    started = time.thread_time()
    while time.thread_time() < started + SECONDS:
        pass
    return Result({"seed": setting.seed})


def sweeping() -> Figures:
    """Measure the share of the least possible time, start of the processes included.

    Points that wait tell what the sweep itself costs; points that compute also what the machine's other work
    does, so that the load stands beside them.
    """
    figures: Figures = {"workers": WORKERS, "points": POINTS, "seconds_a_point": SECONDS}
    for conduct in (waiting, computing):
        EXPERIMENTS[conduct.__name__] = Experiment(conduct, "furnished", 200)
        plan = Plan.create(experiment=conduct.__name__, grid={"views": list(range(200, 200 + POINTS))})
        with TemporaryDirectory() as folder:
            started = time.perf_counter()
            sweep(plan, Path(folder) / "swept", workers=WORKERS)
            spent = time.perf_counter() - started
        figures[f"efficiency_{conduct.__name__}"] = POINTS * SECONDS / WORKERS / spent
    return figures
