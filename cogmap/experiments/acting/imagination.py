"""Imagination: views from where nobody looked, beside what is seen there, and what fires in a dream."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float, UInt8
from sklearn.metrics import r2_score
from sklearn.neighbors import KNeighborsRegressor

from arena import Camera
from arena.angles import wrap_angle
from cogmap.evaluation.image_quality import psnr, ssim
from cogmap.evaluation.populations import perceive
from cogmap.evaluation.pose_agreement import motion_distances
from cogmap.experiments import Conditions, Result, experiment, pose_columns
from cogmap.experiments.acting.dreamer import Dreamer
from cogmap.imagination import Dream
from cogmap.imagination.imagination import Method
from cogmap.plots import plot_dream_errors, plot_dreams, plot_film
from cogmap.threads import one_thread

TARGETS = 300
"""Fresh views that are imagined."""
WAYS = 6
"""Dreamt from one fresh view to another."""
METHODS: tuple[Method, ...] = ("decoder", "turned", "blend", "warp")


@experiment(room="furnished", views=17_000)
def imagination(conditions: Conditions) -> Result:
    """Imagine fresh views, from the pose that the map itself perceives of them and from the true one.

    `psnr_*`, `ssim_mean` and `dream_*` are of "warp" in the map's frame: how like the dream is to the view,
    and how far apart the map places both. `outside_*` asks for the true pose through one similarity, fitted
    on the training views; `decoder_psnr_db` is of what the charts alone decode. Peers in the table are the
    mean view and the nearest by true pose. `replay_r2` is the share of the dreamt ways that is decoded from
    the place cells which fire in the dream (4 nearest neighbours among remembered views). Times are of one
    core.
    """
    dreamer = Dreamer.of(conditions)
    trial, dream = dreamer.trial, dreamer.imagination
    chosen = np.unique(np.linspace(0, len(trial.fresh) - 1, TARGETS).astype(int))
    seen = np.stack([np.asarray(trial.fresh.views[view]) for view in chosen])
    poses = trial.truth.poses[chosen]
    percept = perceive(trial.cmap, seen)
    near = motion_distances(poses, trial.truth.train).argmin(axis=1)
    dreams: dict[str, tuple[UInt8[np.ndarray, "views height width 3"], float]] = {
        "mean view": (np.broadcast_to(np.rint(seen.mean(axis=0)).astype(np.uint8), seen.shape), 0.0),
        "nearest by true pose": (dream.places.views[near], 0.0),
    }
    for method in METHODS:
        dream.at(percept.position[:1], percept.phase[:1], method=method)  # compiled, and learnt
        started = time.process_time()
        made = dream.at(percept.position, percept.phase, method=method)
        dreams[method] = made.views, 1000 * (time.process_time() - started) / len(seen)
    outside = dream.at(*dreamer.asked_from_outside(poses))
    dreams["warp, from outside"] = outside.views, float("nan")
    table = pd.concat(
        [
            pd.DataFrame(
                {
                    "method": name,
                    **pose_columns(poses),
                    "psnr_db": psnr(views, seen),
                    "ssim": ssim(views, seen),
                    **dreamer.apart(perceive(trial.cmap, views), percept),
                    "distance_m": abs(dreamer.frame.scale) * made.distance,
                    "spread": made.spread,
                    "ms": took,
                }
            )
            for name, (views, took) in dreams.items()
        ],
        ignore_index=True,
    )
    ways = dreamt_ways(dreamer, conditions.seed)
    shown = np.linspace(0, len(chosen) - 1, min(5, len(chosen))).astype(int)
    return Result(
        metrics={**_figures(table, dreamer, percept, poses), "replay_r2": replay_r2(dreamer, ways)},
        tables={"dreams": table},
        figures={
            "dreams": plot_dreams(seen[shown], dreams["warp"][0][shown]),
            "errors": plot_dream_errors(conditions.room, table),
            "film": _film(dreamer, conditions, max(ways, key=len)),
        },
        captions={
            "dreams": "Fresh views as they are seen, as they are imagined, and four times the difference",
            "errors": "How good dreams are over the room, and by method",
            "film": "A dreamt way from one view to another, and what is seen on it",
        },
    )


def dreamt_ways(dreamer: Dreamer, seed: int) -> list[Dream]:
    """Dream of ways between fresh views."""
    views = dreamer.trial.fresh.views
    pairs = np.random.default_rng(seed).choice(len(views), (WAYS, 2), replace=False)
    return [
        dreamer.imagination.film(np.asarray(views[int(start)]), np.asarray(views[int(goal)]))
        for start, goal in pairs
    ]


def replay_r2(dreamer: Dreamer, ways: list[Dream]) -> float:
    """Tell the share of the dreamt path that the place cells of the dream tell."""
    train = dreamer.trial.train
    decoder = KNeighborsRegressor(n_neighbors=4, weights="distance")
    with one_thread():
        decoder.fit(train.place, train.position)
        fired = perceive(dreamer.trial.cmap, np.concatenate([way.views for way in ways])).place
        decoded = decoder.predict(fired)
    path = np.concatenate([way.position for way in ways])
    return float(r2_score(path, decoded, multioutput="variance_weighted"))


def _figures(
    table: pd.DataFrame, dreamer: Dreamer, percept: Any, poses: Float[np.ndarray, "views 3"]
) -> dict[str, float]:
    warp, outside = (table[table["method"] == name] for name in ("warp", "warp, from outside"))
    times = table.groupby("method")["ms"].first()
    # the pose that the map perceives of a dream of the true pose, against that of the view there
    relaxed = dreamer.errors(percept, poses)
    return {
        "psnr_median_db": float(warp["psnr_db"].median()),
        "psnr_p05_db": float(warp["psnr_db"].quantile(0.05)),
        "decoder_psnr_db": float(table.loc[table["method"] == "decoder", "psnr_db"].median()),
        "ssim_mean": float(warp["ssim"].mean()),
        "dream_position_median_m": float(warp["position_m"].median()),
        "dream_heading_median_deg": float(warp["heading_deg"].median()),
        "outside_position_median_m": float(outside["position_m"].median()),
        "outside_heading_median_deg": float(outside["heading_deg"].median()),
        "blend_ms": float(times["blend"]),
        "warp_ms": float(times["warp"]),
        "relaxed_position_median_m": float(np.median(relaxed["position_m"])),
        "relaxed_heading_median_deg": float(np.median(relaxed["heading_deg"])),
    }


def _film(dreamer: Dreamer, conditions: Conditions, way: Dream) -> Any:
    """Draw a dreamt way, with what a camera sees on it."""
    heading = dreamer.north.rotation + way.phase * (-1 if dreamer.north.mirror else 1)
    poses = np.column_stack([dreamer.metres(way.position), wrap_angle(heading)])
    seen = Camera.panoramic().render(conditions.room, poses)
    return plot_film(conditions.room, poses, seen, way.views)
