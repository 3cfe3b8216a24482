"""What the demo takes: time, cores, memory, and first compilation."""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.timing import Figures

DEMO = """
from pathlib import Path
from cogmap.cli import main
main()
print(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0])
"""
"""The demo, and then its peak of memory in kB (Linux; `getrusage` would tell that of its parent)."""
PAINT = """
import arena, numpy as np
arena.Camera.panoramic().render(arena.Arena.load("furnished"), np.zeros((1, 3)))
"""


def demonstrating() -> Figures:
    """Run `cogmap demo` in a process of its own, after a small one has compiled what it needs.

    `cores_busy` is the time of all cores over that on the clock. First compilation is that of a process that
    paints one view without cached kernels, beside the same with them.
    """
    with tempfile.TemporaryDirectory() as folder:
        spent("-c", DEMO, "demo", "--views", "3000", "--json", "--out", f"{folder}/small")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds, said = spent("-c", DEMO, "demo", "--json", "--out", f"{folder}/demo")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        *metrics, peak = said.splitlines()
        kernels = {"NUMBA_CACHE_DIR": str(Path(folder) / "kernels")}
        first, again = (spent("-c", PAINT, **kernels)[0] for _ in range(2))
    worked = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    stages = json.loads("".join(metrics))["seconds"]
    return {
        "demo": {
            "seconds": seconds,
            "stages_seconds": stages,
            "cores_busy": worked / seconds,
            "peak_memory_bytes": 1024 * int(peak),
        },
        "compilation": {
            "seconds": first - again,
            "first_view_seconds": first,
            "first_view_with_cached_kernels_seconds": again,
        },
    }


def spent(*arguments: str, **environment: str) -> tuple[float, str]:
    """Seconds that a new Python takes, and what it prints."""
    command, around = [sys.executable, *arguments], {**os.environ, **environment}
    started = time.perf_counter()
    run = subprocess.run(command, env=around, check=True, stdout=subprocess.PIPE, text=True)  # noqa: S603
    return time.perf_counter() - started, run.stdout
