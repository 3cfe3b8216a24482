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
from tqdm import tqdm

from arena import Arena, Body, Brownian, Camera, Nose, Recording, explore
from cogmap.activity import Activity
from cogmap.cells import (
    fit_heading_frame,
    heading_errors,
    heading_statistics,
    place_statistics,
    position_errors,
    rate_maps,
    tuning_curves,
)
from cogmap.cells.decoding import decode_positions
from cogmap.cognitive_map import CognitiveMap
from cogmap.experiments.homologies import homologies
from cogmap.experiments.outputs import METRICS, result_folder
from cogmap.inputs import checked_count
from cogmap.manifold.homology import Betti
from cogmap.plots import (
    plot_barcodes,
    plot_compass,
    plot_position,
    plot_rate_maps,
    plot_room,
    plot_tuning_curves,
    plot_views,
)
from cogmap.scoring import score

FRESH = 5000
"""Views of the recording that scores are taken on, or as many as were learnt from when these are fewer."""
FRESH_SEED = 1000
"""Added to the seed for the fresh recording."""


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


def demo(
    room: Arena,
    out: Path | None,
    *,
    views: int = 17_000,
    charts: int | None = None,
    landmarks: tuple[int, int] = (400, 150),
    seed: int = 0,
    progress: bool = False,
) -> dict[str, Any]:
    """Explore, learn, score on a fresh walk, measure the topology, and draw.

    Parameters
    ----------
    room
        Where to explore.
    out
        Folder for the figures, the map and `metrics.json`; an earlier result there is replaced at the end. None draws nothing.
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
        For a room or counts that cannot work, or a folder that holds something else.
    """
    checked_count("views", views, 20)
    charts = min(3000, views // 3) if charts is None else charts
    with nullcontext() if out is None else result_folder(out) as folder:
        clock = Stopwatch()
        camera, nose = Camera.panoramic(), Nose()

        def walk(count: int, number: int) -> Recording:
            return explore(room, Brownian(), camera, nose=nose, views=count, seed=number, progress=progress)

        with clock("explore"):
            learnt, fresh = walk(views, seed), walk(min(views, FRESH), seed + FRESH_SEED)
        truth, fresh_truth = _poses(learnt), _poses(fresh)
        with clock("learn"):
            cmap = CognitiveMap(charts=charts, seed=seed).fit(learnt.views, learnt.odours, progress=progress)
        with clock("perceive"):
            before, after = cmap.perceive(learnt.views), cmap.perceive(fresh.views)
        with clock("score"):
            reachable = room.sample_free(20_000, Body().radius, np.random.default_rng(0))
            figures = score(after, fresh_truth, train=(before, truth), reachable=reachable)
            nose_error = position_errors(
                np.log(learnt.odours), truth[:, :2], np.log(fresh.odours), fresh_truth[:, :2]
            )
        with clock("homology"):
            bars = homologies(cmap.encode(learnt.views), before, landmarks=landmarks, seed=seed)
        metrics: dict[str, Any] = {
            "arena": room.name,
            "seed": seed,
            "views": views,
            "charts": charts,
            "trusted": cmap.trusted_,
            "reason": cmap.reason_,
            **figures,
            "nose_position_median_m": float(np.median(nose_error)),
            "nose_position_p95_m": float(np.percentile(nose_error, 95)),
            **{f"betti_{name}": list(found.numbers) for name, found in bars.items()},
            "betti_votes": {name: list(found.votes) for name, found in bars.items()},
            "phase_eigenvalue": cmap.phase_eigenvalue_,
        }
        if folder is not None:
            with clock("figures"):
                _draw(folder, room, learnt, fresh, before, after, bars, progress=progress)
                cmap.save(folder / "map")
        metrics["seconds"] = {
            **clock.seconds,
            "learn_by_stage": {k: round(v, 3) for k, v in cmap.seconds_.items()},
        }
        metrics["peak_memory_bytes"] = _peak_memory()
        if folder is not None:
            (folder / METRICS).write_text(json.dumps(metrics, indent=2) + "\n", encoding="utf-8")
        return metrics


def _draw(
    folder: Path,
    room: Arena,
    learnt: Recording,
    fresh: Recording,
    before: Activity,
    after: Activity,
    bars: dict[str, Betti],
    *,
    progress: bool,
) -> None:
    """Write the figures."""
    truth, fresh_truth = _poses(learnt), _poses(fresh)
    positions, headings = fresh_truth[:, :2], fresh_truth[:, 2]
    frame = fit_heading_frame(before.phase, truth[:, 2])
    aligned = headings + heading_errors(after.phase, headings, frame)
    maps = rate_maps(after.place, positions)
    sheet = np.linspace(0, len(learnt) - 1, 18).astype(int)
    drawings = {
        "room": lambda: plot_room(room, truth),
        "views": lambda: plot_views(np.asarray(learnt[sheet].views), truth[sheet]),
        "place_cells": lambda: plot_rate_maps(maps, place_statistics(after.place, positions, headings)),
        "heading_cells": lambda: plot_tuning_curves(
            tuning_curves(after.heading, headings), heading_statistics(after.heading, positions, headings)
        ),
        "compass": lambda: plot_compass(aligned, headings, positions),
        "position": lambda: plot_position(
            decode_positions(before.odour, truth[:, :2], after.odour),
            positions,
            decode_positions(np.log(learnt.odours), truth[:, :2], np.log(fresh.odours)),
        ),
        "barcodes": lambda: plot_barcodes(bars),
    }
    for name, draw in tqdm(drawings.items(), unit="figure", disable=not progress):
        draw().savefig(folder / f"{name}.png")


def _poses(recording: Recording) -> np.ndarray:
    """Ground truth, which `explore` always records."""
    if recording.poses is None:
        raise ValueError("a fresh recording has poses")
    return recording.poses


def _peak_memory() -> int:
    """Largest resident memory of this process so far, bytes."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak
