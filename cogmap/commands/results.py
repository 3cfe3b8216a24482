"""Commands that find something out, and the one that shows it."""

import json
import sys
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from arena import Arena
from cogmap.commands.common import Json, MaybePath, Seed, Told, UserPath, tell
from cogmap.errors import CogmapError
from cogmap.experiments.demo import demo
from cogmap.experiments.parameters import FAMILIES, build, by_family, parse, unknown
from cogmap.experiments.registry import experiments, listing, run_experiment
from cogmap.pages.report import report
from cogmap.sweeps import Plan, sweep
from cogmap.tables import as_markdown


def _demo(
    *,
    arena: str = "furnished",
    views: int = 17_000,
    charts: int | None = None,
    seed: Seed = 0,
    out: UserPath = Path("demo"),
    as_json: Json = False,
) -> None:
    """Explore a room, learn from sight and smell, and show the cells that emerge.

    Examples: `cogmap demo`; `cogmap demo --arena pillar --seed 1 --out pillar --json`.

    Parameters
    ----------
    arena
        A room of the gallery or a TOML file.
    views
        Views to learn from.
    charts
        Of the map; 3000 by default, a third of the views when these are few.
    out
        Folder for figures, map and metrics.
    """
    metrics = demo(
        Arena.load(arena), out, views=views, charts=charts, seed=seed, progress=sys.stderr.isatty()
    )
    if not metrics["trusted"]:
        sys.stderr.write(f"cogmap: this map is not to be trusted: {metrics['reason']}\n")
    tell(metrics, as_json=as_json)


def _help() -> str:
    """Help of `cogmap experiment`: every experiment by what it is about, with what it does."""
    families: dict[str, list[str]] = {}
    for entry in listing():
        families.setdefault(entry["about"], []).append(f"- {entry['experiment']}: {entry['what it does']}")
    listed = "\n\n".join(f"{family}:\n\n" + "\n".join(lines) for family, lines in families.items())
    return f"""Run an experiment: a table of metrics, figures, and the data behind them.

{listed}

Examples: `cogmap experiment rotation`; `cogmap experiment brownian --views 4000 --seed 1 --out walk`;
`cogmap experiment fusion --arena pillar --set map.charts=2000`; `cogmap experiment --list`.
"""


experiment_command = App(name="experiment", help=_help())


@experiment_command.default
def _experiment(
    name: str | None = None,
    /,
    *,
    arena: str | None = None,
    views: int | None = None,
    seed: Seed = 0,
    out: MaybePath = None,
    told: Told = None,
    show: Annotated[bool, Parameter(name="--list", negative="")] = False,
    as_json: Json = False,
) -> None:
    """Run an experiment.

    Parameters
    ----------
    name
        Of the experiment.
    arena
        A room of the gallery or a TOML file; the experiment's own by default.
    views
        To learn from; as many as in the paper by default.
    out
        Folder for metrics, figures and data; the name of the experiment by default.
    told
        What differs from its own, as `body.limits=one`; `--list` tells of what.
    show
        Print a table of all experiments instead: what each does, where, on how many views, what may differ.
    """
    if show:
        rows = listing()
        sys.stdout.write((json.dumps(rows, indent=2) if as_json else as_markdown(rows)) + "\n")
        return
    if name is None:
        raise CogmapError("no experiment is given; `cogmap experiment --list` tells which there are")
    overrides = by_family(parse(told or []))
    usual = experiments()[name].body if name in experiments() else ""
    for family in overrides.keys() - {*FAMILIES}:
        raise unknown(family, list(FAMILIES))
    result = run_experiment(
        name,
        Path(name) if out is None else out,
        room=None if arena is None else Arena.load(arena),
        views=views,
        seed=seed,
        progress=sys.stderr.isatty(),
        **{family: build(family, fields, usual=usual) for family, fields in overrides.items()},
    )
    tell(result.metrics, as_json=as_json)


def _sweep(
    plan: UserPath,
    /,
    *,
    out: UserPath,
    scheduler: str | None = None,
    workers: int | None = None,
    retry_failed: Annotated[bool, Parameter(negative="")] = False,
    keep_walks: Annotated[bool, Parameter(negative="")] = False,
    as_json: Json = False,
) -> None:
    """Do an experiment at many points; killed at any moment, the same command goes on.

    Examples: `cogmap sweep sweep.toml --out swept`; `cogmap sweep sweep.toml --out swept --retry-failed`;
    `cogmap sweep sweep.toml --out /shared/swept --scheduler tcp://10.0.0.1:8786 --json`.

    Parameters
    ----------
    plan
        TOML file that says what is varied.
    out
        Folder for the table and the figures; all workers of a scheduler must see it.
    scheduler
        Address of a Dask scheduler, on whose workers the points are done.
    workers
        Processes on this machine; as many as cores by default.
    retry_failed
        Do points that have failed once more.
    keep_walks
        Keep the recordings that points share.
    """
    table = sweep(
        Plan.load(plan),
        out,
        workers=workers,
        scheduler=scheduler,
        retry_failed=retry_failed,
        keep_walks=keep_walks,
        progress=sys.stderr.isatty(),
    )
    failed = table[table["error"] != ""]
    if len(failed):
        sys.stderr.write(
            f"cogmap: {len(failed)} of {len(table)} points failed, the first with {failed['error'].iloc[0]}; "
            "--retry-failed does them again\n"
        )
    untrusted = int((~table["trusted"].fillna(value=True)).sum())
    counts = {"rows": len(table), "failed": len(failed), "untrusted": untrusted}
    tell({"table": str(out / "table.csv"), **counts}, as_json=as_json)


def _page(folder: UserPath, /, *, out: MaybePath = None, as_json: Json = False) -> None:
    """Show a result as one HTML page that needs nothing else: figures, tables, parameters, versions.

    Examples: `cogmap report demo`; `cogmap report rotation --out spin.html`.

    Parameters
    ----------
    folder
        What `cogmap demo`, `cogmap experiment` or a sweep wrote.
    out
        The page; `report.html` in the folder by default. An earlier report there is replaced.
    """
    tell({"report": str(report(folder, out))}, as_json=as_json)
