"""The command line: `cogmap --help`."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated, Any, Literal

import cyclopts
import numpy as np
from cyclopts import App, Parameter
from matplotlib.figure import Figure

from arena import (
    Arena,
    ArenaError,
    Body,
    Camera,
    Nose,
    Recording,
    explore,
    gallery,
)
from arena.motions.catalogue import MOTIONS
from cogmap.cognitive_map import CognitiveMap
from cogmap.errors import CogmapError
from cogmap.experiments.catalogue import experiment
from cogmap.experiments.demo import demo
from cogmap.export import export_nwb
from cogmap.plots import plot_room, plot_sheet
from cogmap.reporting import report
from cogmap.scoring import score
from cogmap.sweeps import Plan, sweep
from cogmap.tables import as_table
from neurons.errors import NeuronsError

app = App(
    name="cogmap",
    help="Grow place cells and head-direction cells from sight and smell alone.",
    version_flags=["--version"],
    result_action="return_value",
)

Json = Annotated[bool, Parameter(name="--json", negative="", help="Print metrics as JSON on stdout.")]
Seed = Annotated[int, Parameter(help="Of everything random; the same seed gives the same arrays.")]


def main() -> None:
    """Run a command; bad input gets one sentence on stderr and exit status 2."""
    try:
        app(sys.argv[1:], exit_on_error=False, print_error=False)
    except (ArenaError, NeuronsError, CogmapError, cyclopts.CycloptsError) as error:
        sentence = " ".join(str(error).split())
        sys.stderr.write(f"cogmap: {sentence}\n")
        raise SystemExit(2) from None
    except KeyboardInterrupt:
        raise SystemExit(130) from None


@app.command(name="demo")
def _demo(
    *,
    arena: str = "furnished",
    views: int = 17_000,
    charts: int | None = None,
    seed: Seed = 0,
    out: Path = Path("demo"),
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
    _report(metrics, as_json=as_json)


@app.command(name="experiment")
def _experiment(
    name: str,
    /,
    *,
    arena: str | None = None,
    views: int | None = None,
    seed: Seed = 0,
    out: Path | None = None,
    as_json: Json = False,
) -> None:
    """Run an experiment of the paper: a table of metrics, figures, and the data behind them.

    On the manifold of views: rotation, cyclic, brownian, similarity, localisation, roadmap and
    distinguishability. On the cells: fusion, walks, sources, acuity, darkness, cue_rotation, goals,
    directionality and neurons. On the holes of all that a map knows: homology.

    Examples: `cogmap experiment rotation`; `cogmap experiment brownian --views 4000 --seed 1 --out walk`;
    `cogmap experiment fusion --arena pillar`; `cogmap experiment localisation --arena obstacles --json`.

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
    """
    result = experiment(
        name,
        Path(name) if out is None else out,
        room=None if arena is None else Arena.load(arena),
        views=views,
        seed=seed,
        progress=sys.stderr.isatty(),
    )
    _report(result.metrics, as_json=as_json)


@app.command(name="sweep")
def _sweep(
    plan: Path,
    /,
    *,
    out: Path,
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
    told = {
        "table": str(out / "table.csv"),
        "rows": len(table),
        "failed": len(failed),
        "untrusted": untrusted,
    }
    _report(told, as_json=as_json)


@app.command(name="arena")
def _arena(
    name: str | None = None,
    /,
    *,
    out: Path | None = None,
    sheet: Path | None = None,
    schema: Annotated[bool, Parameter(negative="")] = False,
    as_json: Json = False,
) -> None:
    """Show a room: what is in it, a picture of it from above, and how it looks from inside.

    Examples: `cogmap arena pillar --out pillar.png --sheet views.png`; `cogmap arena my_room.toml --json`;
    `cogmap arena --schema > arena.schema.json`.

    Parameters
    ----------
    name
        A room of the gallery or a TOML file.
    out
        PNG to write the picture from above to; it must not exist.
    sheet
        PNG to write perspective and panoramic views to; it must not exist.
    schema
        Print the JSON Schema of the TOML files instead.
    """
    if schema:
        _report(Arena.json_schema(), as_json=True)
        return
    if name is None:
        raise CogmapError(f"no room is given; choose one of {', '.join(gallery())} or give a TOML file")
    room = Arena.load(name)
    described = {
        "arena": room.name,
        "walls": len(room.walls),
        "boxes": len(room.boxes),
        "pillars": len(room.pillars),
        "blocks": len(room.blocks),
        "odour_sources": len(room.sources),
        "free_area_m2": float(room.free_space(Body().radius).area),
    }
    for path, plot in ((out, plot_room), (sheet, plot_sheet)):
        if path is not None:
            _check_absent(path)
            _save(plot(room), path)
    _report(described, as_json=as_json)


@app.command(name="explore")
def _explore(
    arena: str,
    /,
    *,
    out: Path,
    motion: Literal["brownian", "rotation", "cyclic", "chemotaxis", "track", "replay"] = "brownian",
    odorant: int | None = None,
    path: Path | None = None,
    fit: bool | None = None,
    views: int | None = None,
    camera: Literal["panoramic", "perspective"] = "panoramic",
    width: int | None = None,
    height: int | None = None,
    noise: float = 0.1,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Walk through a room and record what is seen and smelt; a killed exploration goes on when called again.

    Examples: `cogmap explore furnished --out walk.zarr`; `cogmap explore pillar --views 5000 --out p.zarr`;
    `cogmap explore furnished --motion rotation --camera perspective --out spin.zarr`;
    `cogmap explore open_field --motion replay --path rat.csv --fit --out rat.zarr`.

    Parameters
    ----------
    arena
        A room of the gallery or a TOML file.
    out
        Folder of the recording.
    motion
        How to move.
    odorant
        Which odour `chemotaxis` climbs, from 0.
    path
        CSV or NPZ file of the path that `replay` follows: columns t (s), x, y (m) and, optionally, heading
        (rad) or heading_deg.
    fit
        Whether `replay` scales and moves the path to fit the room.
    views
        How many to take; what the motion does by default, such as 17,000 brownian ones, or all of a path.
    camera
        What it looks through: all around, or 90° ahead.
    width, height
        Of the views, pixels; 360×60 all around and 320×240 ahead by default.
    noise
        Standard deviation of the log of the smelt concentration.
    """
    way = {"odorant": odorant, "path": path, "fit": fit}
    size = {"width": width, "height": height}
    recording = explore(
        Arena.load(arena),
        MOTIONS[motion](**{name: value for name, value in way.items() if value is not None}),
        getattr(Camera, camera)(**{name: value for name, value in size.items() if value is not None}),
        nose=Nose(noise=noise),
        views=views,
        seed=seed,
        out=out,
        progress=sys.stderr.isatty(),
    )
    _report(
        {"recording": str(out), "views": len(recording), "odorants": recording.odours.shape[1]},
        as_json=as_json,
    )


@app.command(name="learn")
def _learn(
    recording: Path, /, *, out: Path, charts: int | None = None, seed: Seed = 0, as_json: Json = False
) -> None:
    """Learn a map from the views and odours of a recording.

    Examples: `cogmap learn walk.zarr --out map`; `cogmap learn walk.zarr --charts 1500 --seed 2 --out map2`.

    Parameters
    ----------
    recording
        Folder that `cogmap explore` wrote.
    out
        Folder of the map; it must not exist.
    charts
        Of the map; 3000 by default, a third of the views when these are few.
    """
    walk = Recording.open(recording).without_truth()
    _check_absent(out)
    cmap = CognitiveMap(charts=min(3000, len(walk) // 3) if charts is None else charts, seed=seed)
    cmap.fit(walk.views, walk.odours, progress=sys.stderr.isatty())
    cmap.save(out)
    _report(
        {
            "map": str(out),
            "charts": cmap.charts,
            "trusted": cmap.trusted_,
            "reason": cmap.reason_,
            "metric_reason": cmap.metric_reason_,
            "seconds": cmap.seconds_,
        },
        as_json=as_json,
    )


@app.command(name="score")
def _score(cmap: Path, recording: Path, /, *, train: Path, as_json: Json = False) -> None:
    """Score a map on a fresh recording against the true poses.

    Example: `cogmap score map fresh.zarr --train walk.zarr --json`.

    Parameters
    ----------
    cmap
        Folder that `cogmap learn` wrote.
    recording
        Fresh recording, which the map has not seen.
    train
        The recording that the map was learnt from, on which the decoder is fitted.
    """
    grown = CognitiveMap.load(cmap)
    fresh, walk = _with_truth(recording), _with_truth(train)
    seen, known = grown.perceive(fresh.views), grown.perceive(walk.views)
    figures: dict[str, Any] = dict(
        score(seen, np.asarray(fresh.poses), train=(known, np.asarray(walk.poses)))
    )
    told = {"trusted": grown.trusted_, "reason": grown.reason_, "metric_reason": grown.metric_reason_}
    _report({**told, **figures}, as_json=as_json)


@app.command(name="report")
def _page(folder: Path, /, *, out: Path | None = None, as_json: Json = False) -> None:
    """Show a result as one HTML page that needs nothing else: figures, tables, parameters, versions.

    Examples: `cogmap report demo`; `cogmap report rotation --out spin.html`.

    Parameters
    ----------
    folder
        What `cogmap demo`, `cogmap experiment` or a sweep wrote.
    out
        The page; `report.html` in the folder by default. An earlier report there is replaced.
    """
    _report({"report": str(report(folder, out))}, as_json=as_json)


@app.command(name="export")
def _export(recording: Path, cmap: Path, /, *, out: Path, seed: Seed = 0, as_json: Json = False) -> None:
    """Write a recording with the rates and spikes of a map's cells as NWB; needs `pip install 'cogmap[nwb]'`.

    Example: `cogmap export walk.zarr map --out walk.nwb`.

    Parameters
    ----------
    recording
        Folder that `cogmap explore` wrote.
    cmap
        Folder of the map whose cells look, which `cogmap learn` wrote.
    out
        The file; it must not exist.
    """
    walk, grown = _with_truth(recording), CognitiveMap.load(cmap)
    export_nwb(walk, grown, out, seed=seed)
    _report(
        {"nwb": str(out), "views": len(walk), "units": grown.place_cells + grown.heading_cells},
        as_json=as_json,
    )


def _with_truth(path: Path) -> Recording:
    recording = Recording.open(path)
    if recording.poses is None:
        raise CogmapError(f"{path} has no poses to score against; use a recording that kept them")
    return recording


def _check_absent(out: Path) -> None:
    if out.exists():
        raise CogmapError(
            f"{out} exists already and is left as it is; choose another path or remove it first"
        )


def _save(figure: Figure, path: Path) -> None:
    try:
        figure.savefig(path, format="png")
    except OSError as error:
        raise CogmapError(f"cannot write {path}: {error.strerror}") from None


def _report(metrics: dict[str, Any], *, as_json: bool) -> None:
    text = json.dumps(metrics, indent=2) if as_json else as_table(metrics)
    sys.stdout.write(text + "\n")
