"""`make bench`: every figure of speed, as JSON on stdout and as a table on stderr.

`python -m benchmarks rendering stepping` measures some subjects only.
"""

import json
import os
import platform
import sys

from benchmarks.evaluating import evaluating
from benchmarks.exploring import exploring
from benchmarks.learning import learning
from benchmarks.manifold import manifold
from benchmarks.rendering import rendering
from benchmarks.stepping import stepping
from benchmarks.streaming import streaming
from benchmarks.sweeping import sweeping
from benchmarks.timing import Figures
from benchmarks.walking import walking
from cogmap.tables import as_table

SUBJECTS = {
    subject.__name__: subject
    for subject in (
        rendering,
        walking,
        exploring,
        stepping,
        learning,
        streaming,
        evaluating,
        manifold,
        sweeping,
    )
}


def machine() -> Figures:
    """Say what may explain a figure."""
    return {
        "cores": os.cpu_count() or 0,
        "load_1_min": os.getloadavg()[0],
        "python": platform.python_version(),
    }


def main(names: list[str]) -> None:
    """Measure one subject after the other."""
    unknown = [name for name in names if name not in SUBJECTS]
    if unknown:
        raise SystemExit(f"no benchmark of {', '.join(unknown)}; choose among {', '.join(SUBJECTS)}")
    figures: Figures = {"machine_before": machine()}
    for name in names or SUBJECTS:
        figures[name] = SUBJECTS[name]()
    figures["machine_after"] = machine()
    sys.stderr.write(as_table(figures) + "\n")
    sys.stdout.write(json.dumps(figures, indent=2) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
