"""A new wall in a room that was learnt: which fields split, what surprises, how soon the map is right."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float
from sklearn.metrics import roc_auc_score
from sklearn.utils import gen_batches

from arena import Arena, Camera
from cogmap import cells
from cogmap.errors import CogmapError
from cogmap.evaluation.populations import perceive
from cogmap.evaluation.scoring import score
from cogmap.evaluation.verdicts import MOST, figure_verdict
from cogmap.experiments import Conditions, Result, Trial, experiment
from cogmap.experiments.acting.dreamer import Dreamer
from cogmap.experiments.rooms.many_rooms import Visit
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.plots import plot_new_wall

WALL = {"size": (0.1, 1.2), "height": 1.0, "material": "white"}
"""Stood across the middle of the platform, m."""
WALL_SEED = 3000
"""Added to the seed for walks beside the wall."""
ROUNDS = 16
"""Stretches of a walk after each of which the map is asked again,"""
STRETCHES = 4
"""of which so many are as long as the walk that was learnt from."""
RIGHT = 1.2
"""By how much errors may be larger than in a map of the changed room alone, in one that is right again."""
SEEN = 500
"""Views in which surprise is looked for."""
VISIBLE = 8
"""Difference (grey levels, of the strongest colour) from which on a pixel has changed."""


@experiment(room="open_field", views=17_000, takes=("nose", "motion", "body", "map"))
def new_wall(conditions: Conditions) -> Result:
    """Set a wall into a room that was learnt, and let the map live on beside it.

    The map forgets with a time constant of as many views as it learnt from
    (`CognitiveMap(time_constant=...)`). `split_cells` is the share of place cells with one field before that
    have two or more on the first walk beside the wall, before anything is learnt there; `split_cells_later`
    that after all is. `surprise_auc` is over the pixels of 500 views that are rendered with and without the
    wall: which differ by more than 8 grey levels. `views_to_right` is after how many views beside the wall
    both errors, on another walk there, are at most 1.2 times `alone_*`, those of a map that has learnt the
    room with the wall alone, from as many views as this one without it; null if never. `trusted_and_wrong` is
    the share of the times when it was asked at which it was trusted, took most views for those of its room,
    and an error was beyond what `cogmap.evaluation.verdicts` allows. `before_*` are errors before there was a
    wall, `kept_*` those of the map that learns nothing.

    References
    ----------
    Barry et al. (2006), The boundary vector cell model of place cell firing and spatial memory. Rev.
    Neurosci. 17.
    """
    usual = {"time_constant": conditions.views}
    conditions = replace(conditions, map={**usual, **conditions.map})
    dreamer = Dreamer.of(conditions)
    trial = dreamer.trial
    walled = with_a_wall(conditions.room)
    beside = replace(
        conditions,
        room=walled,
        views=round(conditions.views * ROUNDS / STRETCHES),
        seed=conditions.seed + WALL_SEED,
    )
    other = Trial.of(beside)
    before = Visit.of(trial.cmap, trial)
    living = deepcopy(trial.cmap)
    living.relaxed_places_ = None
    kept = Visit.of(living, trial, other.fresh)
    rows = [{"views": 0, **_told(living, other, conditions.views)}]
    odours = other.walk.require("odours")
    for rows_of in gen_batches(len(other.walk), round(conditions.views / STRETCHES)):
        # no jump: with one it would be another room. One step of all these leads from where it stood
        living.partial_fit(other.walk.views[rows_of], odours[rows_of])
        rows.append({"views": rows_of.stop, **_told(living, other, conditions.views)})
    table = pd.DataFrame(rows)
    plain = _told(_unrefined(trial.cmap), trial, conditions.views)
    alone = replace(other, walk=other.walk[: conditions.views])
    aim = _told(alone.cmap, alone, conditions.views)
    names = ("heading_median_deg", "position_median_m")
    for name in names:
        table[f"{name.partition('_')[0]}_over_alone"] = table[name] / aim[name]
    right = (table[["heading_over_alone", "position_over_alone"]] <= RIGHT).all(axis=1)
    wrong = np.array([_wrong(row) for row in rows])
    after = Visit.of(living, trial, other.fresh)
    return Result(
        metrics={
            "rooms": living.rooms_,
            "split_cells": _split(before, kept),
            "split_cells_later": _split(before, after),
            "surprise_auc": _surprise_auc(dreamer, walled, other),
            "trusted_and_wrong": float(((table["recognised"] > 0.5) & wrong).mean()),
            "views_to_right": int(table["views"][right].min()) if right.any() else None,
            **{f"before_{name}": plain[name] for name in names},
            **{f"alone_{name}": aim[name] for name in names},
            **{f"kept_{name}": float(table[name].iloc[0]) for name in names},
            **{name: float(table[name].iloc[-1]) for name in names},
        },
        tables={"rounds": table},
        figures={"new_wall": plot_new_wall(walled, before.maps, kept.maps, after.maps, table)},
        captions={"new_wall": "Fields beside a new wall, and how soon the map is right again"},
    )


def with_a_wall(room: Arena) -> Arena:
    """Stand a wall in the middle of a room's platform, with space at both its ends.

    Raises
    ------
    CogmapError
        Where it does not fit.
    """
    x, y = room.walkable.centroid.coords[0]
    wall = {**WALL, "center": (x, y)}
    changed = room.model_copy(
        update={"name": f"{room.name}_walled", "boxes": [*(box.model_dump() for box in room.boxes), wall]}
    )
    if changed.free_space(0.18).geom_type != "Polygon":
        raise CogmapError(f"a wall across {room.name!r} parts it; choose a larger room")
    return changed


def _unrefined(cmap: CognitiveMap) -> CognitiveMap:
    plain = deepcopy(cmap)
    plain.relaxed_places_ = None
    return plain


def _told(cmap: CognitiveMap, there: Trial, count: int) -> dict[str, Any]:
    """Score what a map says of a fresh walk, by frames and decoders that know so many views there."""
    known, test = there.walk[:count], perceive(cmap, there.fresh.views)
    train = (perceive(cmap, known.views), known.require("poses"))
    figures = score(test, there.fresh.require("poses"), train=train)
    names = ("heading_median_deg", "heading_p95_deg", "position_median_m", "position_p95_m")
    return {
        "trusted": cmap.trusted_,
        "recognised": float(np.mean(test.room == 0)),
        **{name: figures.get(name, float("nan")) for name in names},
    }


def _wrong(told: dict[str, Any]) -> bool:
    """Whether a map was trusted in an answer that was wrong."""
    figures = {key: told[key] for key, _ in MOST.values()}
    return any(figure_verdict(answer, figures, trusted=told["trusted"]) == "WRONG" for answer in MOST)


def _split(before: Visit, after: Visit) -> float:
    """Share of the cells with one field before that have more after."""
    one, more = (cells.place_fields(visit.maps).number for visit in (before, after))
    single: Bool[np.ndarray, "cells"] = one == 1
    return float(np.mean(more[single] > 1)) if single.any() else float("nan")


def _surprise_auc(dreamer: Dreamer, walled: Arena, other: Trial) -> float:
    poses: Float[np.ndarray, "views 3"] = other.fresh.require("poses")[:SEEN]
    eye = Camera.panoramic()
    views, without = eye.render(walled, poses), eye.render(dreamer.trial.conditions.room, poses)
    changed = np.abs(views.astype(int) - without).max(axis=3) > VISIBLE
    found = dreamer.imagination.surprise(views)
    return float(roc_auc_score(changed.ravel(), found.pixels.ravel()))
