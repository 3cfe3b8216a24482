"""Commands about maps: learn one, score it, write down what its cells do."""

import sys
import warnings
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from cyclopts import Parameter

from arena import Recording
from arena.atomic import check_absent
from cogmap.commands.common import Json, Seed, UserPath, tell
from cogmap.errors import CogmapError, UntrustedMapWarning
from cogmap.evaluation.populations import usual_charts
from cogmap.evaluation.scoring import score
from cogmap.export import export_nwb
from cogmap.map.cognitive_map import CognitiveMap


def _learn(
    recording: UserPath,
    /,
    *,
    out: UserPath,
    charts: int | None = None,
    refine: Annotated[bool, Parameter(negative="")] = False,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Learn a map from the views and odours of a recording.

    Examples: `cogmap learn walk.zarr --out map`; `cogmap learn walk.zarr --charts 1500 --seed 2 --out map2`;
    `cogmap learn walk.zarr --refine --out map`.

    Parameters
    ----------
    recording
        Folder that `cogmap explore` wrote.
    out
        Folder of the map; it must not exist.
    charts
        Of the map; 3000 by default, a third of the views when these are few.
    refine
        Relax places by the same views, so that `reach` and `dream` need not; 2.7 KB a view.
    """
    walk = Recording.open(recording).without_truth()
    check_absent(out, CogmapError)
    cmap = CognitiveMap(charts=usual_charts(len(walk)) if charts is None else charts, seed=seed)
    cmap.fit(walk.views, walk.odours, progress=sys.stderr.isatty())
    about = {"map": str(out), "charts": cmap.charts, **_verdict(cmap), "seconds": cmap.seconds_}
    if refine:
        cmap.refine(walk.views)
        about["refine_reason"] = cmap.refine_reason_
    cmap.save(out)
    tell(about, as_json=as_json)


def _score(cmap: UserPath, recording: UserPath, /, *, train: UserPath, as_json: Json = False) -> None:
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
    if not grown.trusted_:
        sys.stderr.write(f"cogmap: this map is not to be trusted: {grown.reason_}\n")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UntrustedMapWarning)  # it is said
        seen, known = grown.perceive(fresh.views), grown.perceive(walk.views)
    figures = score(seen, np.asarray(fresh.poses), train=(known, np.asarray(walk.poses)))
    tell({**_verdict(grown), **figures}, as_json=as_json)


def _export(
    recording: UserPath, cmap: UserPath, /, *, out: UserPath, seed: Seed = 0, as_json: Json = False
) -> None:
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
    units = grown.place_cells + grown.heading_cells
    tell({"nwb": str(out), "views": len(walk), "units": units}, as_json=as_json)


def _with_truth(path: Path) -> Recording:
    """Open a recording that has poses."""
    recording = Recording.open(path)
    if recording.poses is None:
        raise CogmapError(f"{path} has no poses to score against; use a recording that kept them")
    return recording


def _verdict(cmap: CognitiveMap) -> dict[str, Any]:
    """Tell whether a map is to be trusted, and why not."""
    return {"trusted": cmap.trusted_, "reason": cmap.reason_, "metric_reason": cmap.metric_reason_}
