"""What may explain a figure: the machine, and the versions of what calculates."""

import platform
from importlib.metadata import version
from pathlib import Path

import joblib

from benchmarks.timing import Figures

LIBRARIES = ("numpy", "numba", "torch", "scipy", "scikit-learn", "gudhi", "pymunk")


def machine() -> Figures:
    """Say what measures; nothing that tells whose it is."""
    return {
        "processor": processor(),
        "cores": joblib.cpu_count(),
        "python": platform.python_version(),
        **{library: version(library) for library in LIBRARIES},
    }


def processor(told: Path = Path("/proc/cpuinfo")) -> str:
    """Name the processor, as Linux does, or else its kind."""
    lines = told.read_text().splitlines() if told.exists() else []
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(names, platform.machine())
