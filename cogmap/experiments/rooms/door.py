"""Doors: two rooms that a door joins, and a third behind a second door, as one piece with one compass."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from matplotlib.figure import Figure

from cogmap.cells.decoding.decoders import fit_heading_frame, heading_errors
from cogmap.evaluation.homology_of_map import homologies
from cogmap.evaluation.populations import trust_report
from cogmap.experiments import Conditions, Result, Trial, experiment
from cogmap.experiments.rooms.many_rooms import room_of_house
from cogmap.plots import plot_compass

PLATFORM = 12.0
"""Area (m²) of the platform that the usual numbers of views, charts and cells are for."""


@experiment(room="two_rooms", views=27_000, takes=("nose", "motion", "camera", "body", "map"))
def door(conditions: Conditions) -> Result:
    """Walk through doors: two rooms, then three in a row, each learnt as one map with one compass.

    Few views see through a door, and few ways lead through it, so that the compass of one room might come to
    stand against that of the other. Views are as many on a square metre as 17,000 in a room of one platform;
    charts and place cells are in proportion. `pieces` are those of the atlas: 1 where the door joins.
    """
    metrics: dict[str, Any] = {}
    figures: dict[str, Figure] = {}
    captions: dict[str, str] = {}
    rooms = {"": conditions.room}
    if conditions.room.name == "two_rooms":
        rooms["third_room_"] = room_of_house("three_rooms")
    for prefix, room in rooms.items():
        views = round(conditions.views * room.walkable.area / conditions.room.walkable.area)
        share = room.walkable.area / PLATFORM
        sizes = {"charts": min(round(3000 * share), views // 3), "place_cells": round(150 * share)}
        trial = Trial.of(replace(conditions, room=room, views=views, map={**sizes, **conditions.map}))
        cmap = trial.cmap
        found = homologies(trial.codes[0], trial.train, trial.smells[0], seed=conditions.seed)
        wanted = ("heading_median_deg", "heading_p95_deg", "position_median_m", "position_p95_m")
        told = {
            **trust_report(cmap),
            **{key: trial.score[key] for key in (*wanted, "metric_map_r2") if key in trial.score},
            "pieces": cmap.rooms_,
            "views": views,
            "betti": {name: list(each.numbers) for name, each in found.items()},
            "betti_resolved": {name: each.resolved for name, each in found.items()},
        }
        metrics |= {f"{prefix}{key}": value for key, value in told.items()}
        if "heading_median_deg" not in trial.score:
            continue
        frame = fit_heading_frame(trial.train.phase, trial.truth.train[:, 2])
        poses = trial.truth.poses
        off = heading_errors(trial.test.phase, poses[:, 2], frame)
        name = f"{prefix}heading"
        figures[name] = plot_compass(poses[:, 2] + off, poses[:, 2], poses[:, :2])
        captions[name] = f"Headings in {room.name}: learnt against true, and where they are off"
    return Result(metrics, {}, figures, captions)
