"""A sweep from its plan to its table and figures."""

import warnings
from functools import partial
from pathlib import Path

import pandas as pd
from tqdm import tqdm

from cogmap.atomic import user_path
from cogmap.crew import on_cluster, on_this_machine
from cogmap.digests import SUMS, sums
from cogmap.errors import CogmapError, UnlikeArithmeticWarning
from cogmap.experiments.provenance import PROVENANCE, write_provenance
from cogmap.experiments.registry import experiments
from cogmap.inputs import Whole, checked_count
from cogmap.plots.sweep import plot_trend, statistics_of
from cogmap.sweeps.ledger import Ledger, Record, disk_errors
from cogmap.sweeps.plan import Plan
from cogmap.sweeps.points import points_of
from cogmap.sweeps.running import WORDING, do
from cogmap.sweeps.table import table_of
from cogmap.tables import write_table

PLAN = "plan.toml"
"""The plan, in the folder of its sweep."""


def sweep(
    plan: Plan,
    out: str | Path,
    *,
    workers: Whole | None = None,
    scheduler: str | None = None,
    retry_failed: bool = False,
    keep_walks: bool = False,
    progress: bool = False,
) -> pd.DataFrame:
    """Do an experiment at every point of a plan with every seed.

    Each finished point is a file in `out`, so that after a kill the same call goes on and does none of them
    twice. A point that fails is put down with its error, and the others go on. The table is the same bit by
    bit whatever the number of processes, and whoever does the points where all calculate alike: on
    processors of one kind, or on any with portable arithmetic. Where they do not, a warning says so.

    Parameters
    ----------
    plan
        What is varied, as `Plan.load("sweep.toml")`.
    out
        Folder for `table.csv`, `table.parquet`, `figures`, the plan and what is needed to go on. With a
        scheduler, all workers must see it by this path.
    workers
        Processes on this machine; as many as cores when None.
    scheduler
        Address of a Dask scheduler, on whose workers the points are done instead.
    retry_failed
        Whether points that have failed are done again.
    keep_walks
        Whether recordings that points share are kept in `out` at the end.
    progress
        Whether to show a bar with the time left on stderr.

    Returns
    -------
    pd.DataFrame
        A row for each point and seed: what varies, `seed`, the metrics with nested names joined by dots, and
        `trusted`, `reason` and `error`; without times and memory.

    Raises
    ------
    ArenaError, CogmapError
        For a plan that cannot be, before anything is done; a folder that holds something else; a full disk; a
        scheduler that does not answer.
    """
    workers = None if workers is None else checked_count("workers", workers)
    if workers is not None and scheduler is not None:
        raise CogmapError("workers are counted on this machine and a scheduler has its own; give one of them")
    points = points_of(plan)
    ledger = Ledger(user_path(out).resolve())
    with ledger.opened(plan, points, keep_walks=keep_walks):
        left = [point for point in points if ledger.lacks(point, again=retry_failed)]
        work = partial(do, ledger=ledger, chosen=experiments()[plan.experiment], again=retry_failed)
        bar = tqdm(total=len(points), initial=len(points) - len(left), unit="point", disable=not progress)
        with bar:
            if left:
                doing = (
                    on_this_machine(work, left, workers, WORDING)
                    if scheduler is None
                    else on_cluster(work, left, scheduler, WORDING)
                )
                for _ in doing:
                    bar.update()
        records = [record for point in points if (record := ledger.read(point)) is not None]
        if len(records) < len(points):
            raise CogmapError(
                f"a point that was done has vanished from {ledger.folder}; give the same command again"
            )
        table = table_of(points, records)
        _warn_of_unlike(records)
        _write(ledger, table, plan)
    return table


def _warn_of_unlike(records: list[Record]) -> None:
    """Say so when points were done by processors that calculate differently."""
    found = {record["arithmetic"] for record in records if "arithmetic" in record}
    if len(found) > 1:
        warnings.warn(
            f"the points of this sweep were done in {len(found)} arithmetics ({', '.join(sorted(found))}) "
            "and may differ by rounding; start the sweep and all workers with `cogmap portable`",
            UnlikeArithmeticWarning,
            stacklevel=3,
        )


def _write(ledger: Ledger, table: pd.DataFrame, plan: Plan) -> None:
    """Write the table and its figures, and how to do it again."""
    for name in ("table.csv", "table.parquet"):
        with ledger.replacing(ledger.folder / name) as fresh:
            write_table(table, fresh)
    with ledger.replacing(ledger.folder / "figures") as fresh:
        fresh.mkdir()
        for name in statistics_of(table, plan.varied):
            figure = plot_trend(
                table,
                name,
                plan.varied,
                logarithmic=plan.logarithmic,
                labels=plan.labels,
                joined=plan.sample is None,
            )
            figure.savefig(fresh / f"{name}.png")
    with ledger.replacing(ledger.folder / PLAN) as fresh:
        fresh.write_text(plan.to_toml(), encoding="utf-8")
    with disk_errors(ledger.folder):
        write_provenance(ledger.folder, ("sweep", PLAN), None)
        written = [ledger.folder / name for name in ("table.csv", "table.parquet", PLAN, PROVENANCE)]
        figures = (ledger.folder / "figures").iterdir()
        with ledger.replacing(ledger.folder / SUMS) as fresh:
            fresh.write_text(sums(ledger.folder, [*written, *figures]), encoding="utf-8")
