"""The main job: explore a room, learn from sight and smell, show the cells that emerge."""

from __future__ import annotations

import json
import resource
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from arena import Arena, Brownian, Camera, Disc, Recording, explore
from cogmap.atomic import METRICS, result_folder
from cogmap.cells import (
    fit_heading_frame,
    fit_map_frame,
    heading_errors,
    heading_statistics,
    place_map,
    place_statistics,
    position_errors,
    rate_maps,
    tuning_curves,
)
from cogmap.cells.decoding.decoders import decode_positions
from cogmap.errors import CogmapError
from cogmap.evaluation.homology_of_map import homologies
from cogmap.evaluation.scoring import score
from cogmap.experiments.conditions import FRESH, FRESH_SEED, poses_of
from cogmap.experiments.provenance import write_provenance
from cogmap.inputs import checked_count
from cogmap.map.activity import Activity
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.plots import (
    plot_barcodes,
    plot_compass,
    plot_metric_map,
    plot_position,
    plot_rate_maps,
    plot_room,
    plot_tuning_curves,
    plot_views,
)
from cogmap.shape.homology import Betti

LANDMARKS = (400, 150)
"""On which loops and voids are measured."""


@dataclass
class Stopwatch:
    """Seconds by stage."""

    seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def __call__(self, stage: str) -> Iterator[None]:
        """Time what is done inside."""
        started = time.perf_counter()
        yield
        self.seconds[stage] = round(time.perf_counter() - started, 3)


@dataclass(frozen=True)
class Outing:
    """A walk, where it really led, and what a map perceives on it."""

    walk: Recording
    poses: Float[np.ndarray, "views 3"]
    activity: Activity


def demo(
    room: Arena,
    out: Path | None,
    *,
    views: int = 17_000,
    charts: int | None = None,
    landmarks: tuple[int, int] = LANDMARKS,
    seed: int = 0,
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
        The figures of `cogmap.score`, the nose's own position error, Betti numbers, seconds by stage, memory.

    Raises
    ------
    ArenaError, CogmapError
        For a room or counts that cannot work, a folder that holds something else, or a map without a compass.
    """
    checked_count("views", views, 20)
    charts = min(3000, views // 3) if charts is None else charts
    clock = Stopwatch()
    with nullcontext() if out is None else result_folder(out) as folder:
        with clock("explore"):
            walks = [
                explore(room, Brownian(), Camera.panoramic(), views=count, seed=number, progress=progress)
                for count, number in ((views, seed), (min(views, FRESH), seed + FRESH_SEED))
            ]
        cmap = CognitiveMap(charts=charts, seed=seed)
        with clock("learn"):
            cmap.fit(walks[0].views, walks[0].odours, progress=progress)
        if not np.isfinite(cmap.phase_eigenvalue_):
            raise CogmapError(f"the map has no compass: {cmap.reason_}")
        with clock("perceive"):
            learnt, fresh = (Outing(walk, poses_of(walk), cmap.perceive(walk.views)) for walk in walks)
        with clock("score"):
            figures = _score(room, learnt, fresh)
        with clock("homology"):
            bars = homologies(cmap.encode(learnt.walk.views), learnt.activity, landmarks=landmarks, seed=seed)
        if folder is not None:
            with clock("figures"):
                _draw(folder, room, learnt, fresh, bars)
                cmap.save(folder / "map")
        metrics = {
            "arena": room.name,
            "seed": seed,
            "views": views,
            "charts": charts,
            "trusted": cmap.trusted_,
            "reason": cmap.reason_,
            "metric_reason": cmap.metric_reason_,
            **figures,
            **{f"betti_{name}": list(found.numbers) for name, found in bars.items()},
            "betti_votes": {name: list(found.votes) for name, found in bars.items()},
            "phase_eigenvalue": cmap.phase_eigenvalue_,
            "seconds": clock.seconds,
            "learn_seconds": {stage: round(spent, 3) for stage, spent in cmap.seconds_.items()},
            "peak_memory_bytes": _peak_memory(),
        }
        if folder is not None:
            (folder / METRICS).write_text(json.dumps(metrics, indent=2) + "\n", encoding="utf-8")
            overrides = {} if landmarks == LANDMARKS else {"landmarks": landmarks}
            write_provenance(folder, ("demo",), room, views=views, charts=charts, seed=seed, **overrides)
        return metrics


def _score(room: Arena, learnt: Outing, fresh: Outing) -> dict[str, float]:
    """Every figure of `score`, and the position error of the raw nose read by the same decoder."""
    reachable = room.sample_free(20_000, Disc().radius, np.random.default_rng(0))
    raw = position_errors(
        np.log(learnt.walk.require("odours")),
        learnt.poses[:, :2],
        np.log(fresh.walk.require("odours")),
        fresh.poses[:, :2],
    )
    return {
        **score(fresh.activity, fresh.poses, train=(learnt.activity, learnt.poses), reachable=reachable),
        "nose_position_median_m": float(np.median(raw)),
        "nose_position_p95_m": float(np.percentile(raw, 95)),
    }


def _draw(folder: Path, room: Arena, learnt: Outing, fresh: Outing, bars: dict[str, Betti]) -> None:
    """Write the figures."""
    positions, headings = fresh.poses[:, :2], fresh.poses[:, 2]
    rates = fresh.activity
    frame = fit_heading_frame(learnt.activity.phase, learnt.poses[:, 2])
    aligned = headings + heading_errors(rates.phase, headings, frame)
    sheet = np.linspace(0, len(learnt.walk) - 1, 18).astype(int)
    known = learnt.poses[:, :2]
    smells = [np.log(outing.walk.require("odours")) for outing in (learnt, fresh)]
    smelt = decode_positions(smells[0], known, smells[1])
    drawings = {
        "room": plot_room(room, learnt.poses),
        "views": plot_views(np.asarray(learnt.walk[sheet].views), learnt.poses[sheet]),
        "place_cells": plot_rate_maps(
            rate_maps(rates.place, positions), place_statistics(rates.place, positions, headings)
        ),
        "heading_cells": plot_tuning_curves(
            tuning_curves(rates.heading, headings), heading_statistics(rates.heading, positions, headings)
        ),
        "compass": plot_compass(aligned, headings, positions),
        "position": plot_position(
            decode_positions(learnt.activity.odour, known, rates.odour), positions, smelt
        ),
        "barcodes": plot_barcodes(bars),
    }
    if not np.isnan(rates.position).all():
        laid = place_map(rates.position, fit_map_frame(learnt.activity.position, known))
        drawings["metric_map"] = plot_metric_map(laid, positions)
    for name, figure in drawings.items():
        figure.savefig(folder / f"{name}.png")


def _peak_memory() -> int:
    """Largest resident memory of this process so far, bytes."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak
