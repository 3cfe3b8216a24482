"""The main job: explore a room, learn from sight and smell, show the cells that emerge."""

from __future__ import annotations

import resource
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import fields
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from arena import Arena
from cogmap import plots
from cogmap.atomic import result_folder
from cogmap.cells import decode_positions, fit_heading_frame, fit_map_frame, heading_errors, place_map
from cogmap.evaluation.homology_of_map import homologies
from cogmap.evaluation.populations import usual_charts
from cogmap.experiments.conditions import Conditions
from cogmap.experiments.provenance import write_provenance
from cogmap.experiments.result import Result
from cogmap.experiments.trial import Trial
from cogmap.inputs import Whole, checked_count
from cogmap.map.diagnosis import Diagnosis
from cogmap.shape.homology import Betti

LANDMARKS = (400, 150)
"""On which loops and voids are measured."""


def demo(
    room: Arena,
    out: str | Path | None,
    *,
    views: Whole = 17_000,
    charts: Whole | None = None,
    landmarks: tuple[int, int] = LANDMARKS,
    seed: Whole = 0,
    progress: bool = False,
) -> dict[str, Any]:
    """Explore, learn, score on a fresh walk, measure the topology, and draw.

    Parameters
    ----------
    room
        Where to explore.
    out
        Folder for the figures, the map and `metrics.json`; an earlier result there is replaced at the end.
        None draws nothing.
    views
        Views to learn from.
    charts
        Of the map; 3000, or a third of the views when these are fewer than 9,000.
    landmarks
        On which loops and voids are measured.
    seed
        Of walk, noise and initial weights; the fresh walk uses seed + 1000.
    progress
        Whether to show progress on stderr.

    Returns
    -------
    dict
        Whether the map, its heading, place, metric map and topology are to be trusted; the figures of
        `cogmap.score`, the nose's own position error, Betti numbers, which of them are resolved and why the
        others are not, seconds by stage, memory. What a map without a compass cannot say is left out.

    Raises
    ------
    ArenaError, CogmapError
        For a room or counts that cannot work, or a folder that holds something else.
    """
    views, seed = checked_count("views", views, 20), checked_count("seed", seed, 0)
    charts = usual_charts(views) if charts is None else checked_count("charts", charts)
    seconds: dict[str, float] = {}
    clock = partial(_timed, seconds)
    with nullcontext() if out is None else result_folder(out) as folder, TemporaryDirectory() as scratch:
        # views stay on disk: a gigabyte, of which batches are in memory
        conditions = Conditions(room, views, seed, progress, Path(scratch), map={"charts": charts})
        with clock("explore"):
            trial = Trial.of(conditions)
        with clock("learn"):
            cmap = trial.cmap
        with clock("perceive"):
            learnt, _ = trial.train, trial.test
        with clock("score"):
            figures = trial.score | trial.nose_figures
        with clock("homology"):
            codes, smells = cmap.encode(trial.walk.views), trial.smells[0]
            bars = homologies(codes, learnt, smells, landmarks=landmarks, seed=seed)
        if folder is not None:
            with clock("figures"):
                drawn = _draw(trial, bars)
                cmap.save(folder / "map")
        metrics = {
            "arena": room.name,
            "seed": seed,
            "views": views,
            "charts": charts,
            "trusted": cmap.trusted_,
            "reason": cmap.reason_,
            "metric_reason": cmap.metric_reason_,
            **_verdicts(cmap.diagnosis(bars)),
            **figures,
            **{f"betti_{name}": list(found.numbers) for name, found in bars.items()},
            **{f"betti_{name}_resolved": list(found.resolved) for name, found in bars.items()},
            "betti_reasons": {name: list(found.reasons) for name, found in bars.items()},
            "betti_votes": {name: list(found.votes) for name, found in bars.items()},
            "dimension": cmap.dimension_,
            "dimension_vote": cmap.vote_,
            "phase_eigenvalue": cmap.phase_eigenvalue_,
            "seconds": seconds,
            "learn_seconds": {stage: round(spent, 3) for stage, spent in cmap.seconds_.items()},
            "peak_memory_bytes": _peak_memory(),
        }
        if folder is not None:
            drawn.described(metrics).write(folder)
            overrides = {} if landmarks == LANDMARKS else {"landmarks": landmarks}
            write_provenance(folder, ("demo",), room, views=views, charts=charts, seed=seed, **overrides)
        return metrics


@contextmanager
def _timed(seconds: dict[str, float], stage: str) -> Iterator[None]:
    """Note how long what is done inside takes."""
    started = time.perf_counter()
    yield
    seconds[stage] = round(time.perf_counter() - started, 3)


def _verdicts(told: Diagnosis) -> dict[str, Any]:
    """Four answers, each trusted or not, and why not."""
    verdicts = {field.name: getattr(told, field.name) for field in fields(told)}
    reasons = {name: verdict.reason for name, verdict in verdicts.items()}
    return {
        **{f"{name}_trusted": verdict.trusted for name, verdict in verdicts.items()},
        "reasons": reasons,
    }


def _draw(trial: Trial, bars: dict[str, Betti]) -> Result:
    """Draw what the score is of, the very maps and statistics that it has measured."""
    train, poses = trial.truth.train, trial.truth.poses
    positions, headings = poses[:, :2], poses[:, 2]
    learnt, fresh = trial.train, trial.test
    sheet = np.linspace(0, len(train) - 1, 18).astype(int)
    recalled = decode_positions(learnt.odour, train[:, :2], fresh.odour)
    smelt = decode_positions(trial.smells[0], train[:, :2], trial.smells[1])
    drawings = {
        "room": plots.plot_room(trial.conditions.room, train),
        "views": plots.plot_views(np.asarray(trial.walk[sheet].views), train[sheet]),
        "place_cells": plots.plot_rate_maps(trial.place.maps, trial.place.place),
        "position": plots.plot_position(recalled, positions, smelt),
        "barcodes": plots.plot_barcodes(bars),
    }
    if not np.isnan(fresh.phase).all():
        frame = fit_heading_frame(learnt.phase, train[:, 2])
        aligned = headings + heading_errors(fresh.phase, headings, frame)
        curves = trial.heading.tuning.curves
        drawings["heading_cells"] = plots.plot_tuning_curves(curves, trial.heading.heading)
        drawings["compass"] = plots.plot_compass(aligned, headings, positions)
    if not np.isnan(fresh.position).all():
        laid = place_map(fresh.position, fit_map_frame(learnt.position, train[:, :2]))
        drawings["metric_map"] = plots.plot_metric_map(laid, positions)
    captions = {
        "place_cells": "Rate maps of place cells, rate against position",
        "heading_cells": "Tuning curves of head-direction cells, rate against heading",
        "compass": "Learnt against true heading, the same colour for the same direction",
        "position": "Recalled against true position",
        "metric_map": "Where the map believes it is, laid over where it truly is",
    }
    return Result({}, figures=drawings, captions=captions)


def _peak_memory() -> int:
    """Largest resident memory of this process so far, bytes."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak
