"""Commands about maps: learn one, score it, write down what its cells do."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

from arena import Recording
from cogmap.atomic import check_absent
from cogmap.commands.app import Json, Seed, app, tell, with_truth
from cogmap.evaluation.populations import usual_charts
from cogmap.evaluation.scoring import score
from cogmap.export import export_nwb
from cogmap.map.cognitive_map import CognitiveMap


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
    check_absent(out)
    cmap = CognitiveMap(charts=usual_charts(len(walk)) if charts is None else charts, seed=seed)
    cmap.fit(walk.views, walk.odours, progress=sys.stderr.isatty())
    cmap.save(out)
    tell(
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
    fresh, walk = with_truth(recording), with_truth(train)
    seen, known = grown.perceive(fresh.views), grown.perceive(walk.views)
    figures: dict[str, Any] = dict(
        score(seen, np.asarray(fresh.poses), train=(known, np.asarray(walk.poses)))
    )
    summary = {"trusted": grown.trusted_, "reason": grown.reason_, "metric_reason": grown.metric_reason_}
    tell({**summary, **figures}, as_json=as_json)


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
    walk, grown = with_truth(recording), CognitiveMap.load(cmap)
    export_nwb(walk, grown, out, seed=seed)
    tell(
        {"nwb": str(out), "views": len(walk), "units": grown.place_cells + grown.heading_cells},
        as_json=as_json,
    )
