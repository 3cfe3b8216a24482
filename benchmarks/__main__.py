"""`make bench`: every figure of speed, as JSON on stdout and as a table on stderr, and as a page."""

import inspect
import json
import os
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from benchmarks.growth_figure import plot_growth
from benchmarks.machine import machine
from benchmarks.page import as_page
from benchmarks.timing import Figures
from cogmap.atomic import atomic_write
from cogmap.tables import as_table

SUBJECTS = (
    "rendering",
    "walking",
    "exploring",
    "stepping",
    "learning",
    "streaming",
    "evaluating",
    "manifold",
    "homology",
    "demonstrating",
    "living",
    "sweeping",
    "scaling",
)
"""Modules, each with a function of its name. One has experiments: it is imported only to be measured."""

app = App(name="benchmarks", help_format="plaintext", result_action="return_value")


@app.default
def bench(
    *names: str,
    known: Annotated[Path | None, Parameter("--from")] = None,
    report: Path | None = None,
) -> None:
    """Measure subjects one after the other, or all.

    Parameters
    ----------
    names
        Of the subjects.
    known
        JSON of figures that were printed before: they are kept, and only the named subjects measured.
    report
        Markdown page to write, beside its figure of the same name.
    """
    unknown = [name for name in names if name not in SUBJECTS]
    if unknown:
        raise SystemExit(f"no benchmark of {', '.join(unknown)}; choose among {', '.join(SUBJECTS)}")
    figures: Figures = json.loads(known.read_text()) if known else {}
    for name in names or (() if known else SUBJECTS):
        figures |= {"machine": machine(), name: measured(name)}
    if report:
        write_page(figures, report)
    sys.stderr.write(as_table(figures) + "\n")
    sys.stdout.write(json.dumps(figures, indent=2) + "\n")


def write_page(figures: Figures, report: Path) -> None:
    """Write the page, and beside it the figure of how cost grows, if that was measured."""
    said = {name: inspect.getdoc(subject(name)) or "" for name in SUBJECTS if name in figures}
    drawn = report.with_suffix(".png")
    if "scaling" in figures:
        with atomic_write(drawn) as fresh:
            plot_growth(figures["scaling"]).savefig(fresh, format="png")
    with atomic_write(report) as fresh:
        fresh.write_text(as_page(figures, said, drawn.name), encoding="utf-8")


def subject(name: str) -> Callable[[], Figures]:
    """Import what measures it."""
    found: Callable[[], Figures] = getattr(import_module(f"benchmarks.{name}"), name)
    return found


def measured(name: str) -> Figures:
    """Measure a subject, and how busy the machine was before and after."""
    before = os.getloadavg()[0]
    figures = subject(name)()
    return {**figures, "load_before": before, "load_after": os.getloadavg()[0]}


if __name__ == "__main__":
    app()
