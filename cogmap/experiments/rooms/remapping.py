"""Remapping: ten rooms in one map, and what has to change in a room for its cells to remap."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd

from arena import Arena
from arena.rooms.light import Light
from cogmap import cells
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.rooms.many_rooms import (
    HOUSE,
    Visit,
    active,
    blank_map,
    house_of,
    population_correlation,
    rate_change,
)
from cogmap.experiments.trial import Trial
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.plots import plot_remapping

GLOBAL = 0.5
"""Remapping index from which on cells have remapped globally,"""
RATE = 2.0
"""and by how many times as much as where nothing changes rates must differ where they have not."""
ALONE = 3
"""Maps of a room alone, of other initial weights: one may well be 1.4 times as good as another in its
headings."""
CHANGED_SEED = 5000
"""Added to the seed for walks through changed rooms."""


@experiment(room="furnished", views=8000, any_room=False, takes=("nose", "motion", "camera", "body", "map"))
def remapping(conditions: Conditions) -> Result:
    """Learn ten rooms one after the other in one map, without being told which, and compare their cells.

    The rooms are as large and share materials; some share their sources of odour. Each is learnt from its own
    walk and never visited again while others are learnt. `heading_over_alone` and `position_over_alone` are
    errors over those of a map of that room alone, the mean of three of other initial weights as far as they
    are trusted, of the worst room, and NaN where one has none; `room_recognised` is the share of fresh
    views of the worst room that sight alone takes for it. Population vectors of place cells are
    correlated place by place: between rooms (`between_correlation`, the mean over pairs), within a room
    between two fresh walks at the end, and on return (`return_correlation`, of the worst room) between a
    fresh walk as soon as it was learnt and another when all were. The remapping index of a pair is
    1 − between / within.

    Then one thing is changed in the first room, and the map of it walks there and may learn on: where most
    views or smells are of no room that it knows, it begins another. `changes` tells what each change did:
    global remapping where the index is above .5, rate remapping where fields stay and rates differ twice as
    much as where nothing was changed, or none.

    References
    ----------
    Leutgeb et al. (2005), Independent codes for spatial and episodic memory in hippocampal neuronal
    ensembles. Science 309.
    Alme et al. (2014), Place cells in the hippocampus: eleven maps for eleven rooms. PNAS 111.
    """
    trials = house_of(conditions)
    cmap = blank_map(conditions)
    first: list[cells.RateMaps] = []
    for trial in trials:
        cmap.fit(trial.walk.views, trial.walk.odours, further=True, progress=conditions.progress)
        first.append(Visit.of(cmap, trial).maps)
        if len(first) == 1:
            alone = deepcopy(cmap)
    rows, again = [], []
    for number, (trial, before) in enumerate(zip(trials, first, strict=True)):
        there = Visit.of(cmap, trial)
        back = Visit.of(cmap, trial, _once_more(trial))
        rows.append(_compared(number, trial, there, back, before))
        again.append(there.maps)
    rooms = pd.DataFrame(rows)
    pairs = pd.DataFrame(
        [
            _pair((HOUSE[one], again[one]), (HOUSE[other], again[other]), rooms["within_correlation"].mean())
            for one, other in combinations(range(len(again)), 2)
        ]
    )
    changes = pd.DataFrame(_changed(alone, trials[0], conditions))
    return Result(
        metrics={
            "rooms": cmap.rooms_,
            "trusted": cmap.trusted_,
            "reason": cmap.reason_,
            "components": cmap.encode(trials[0].fresh.views[:1]).shape[1],
            "heading_over_alone": float(rooms["heading_over_alone"].max(skipna=False)),
            "position_over_alone": float(rooms["position_over_alone"].max(skipna=False)),
            "room_recognised": float(rooms["recognised"].min()),
            "between_correlation": float(pairs["correlation"].mean()),
            "largest_between_correlation": float(pairs["correlation"].max()),
            "within_correlation": float(rooms["within_correlation"].min()),
            "return_correlation": float(rooms["return_correlation"].min()),
            "remapping_index": float(pairs["remapping_index"].mean()),
            "active_share": float(rooms["active_share"].mean()),
            "active_in_both": float(pairs["active_in_both"].mean()),
            "changes": dict(zip(changes["change"], changes["remapping"], strict=True)),
        },
        tables={"rooms": rooms, "pairs": pairs, "changes": changes},
        figures={"remapping": plot_remapping(dict(zip(HOUSE, again, strict=True)), pairs, changes)},
        captions={
            "remapping": "Fields of the same cells in ten rooms, how alike rooms are to the population, and "
            "what each change of a room does"
        },
    )


def _once_more(trial: Trial) -> Any:
    """Walk afresh through the same room, another way."""
    conditions = replace(trial.conditions, seed=trial.conditions.seed + CHANGED_SEED)
    return Trial.of(conditions).fresh


def _compared(number: int, trial: Trial, there: Visit, back: Visit, before: cells.RateMaps) -> dict[str, Any]:
    """Put what a map of many rooms makes of one beside what a map of that one makes."""
    many = there.figures
    names = ("heading_median_deg", "position_median_m")
    known = {name: many.get(name, np.nan) for name in names}
    alone = pd.DataFrame([_alone(trial, extra) for extra in range(ALONE)], columns=list(names)).mean()
    return {
        "room": HOUSE[number],
        "recognised": there.recognised(number),
        **known,
        "heading_alone_deg": alone["heading_median_deg"],
        "position_alone_m": alone["position_median_m"],
        "heading_over_alone": known["heading_median_deg"] / alone["heading_median_deg"],
        "position_over_alone": known["position_median_m"] / alone["position_median_m"],
        "within_correlation": population_correlation(there.maps, back.maps),
        "return_correlation": population_correlation(before, back.maps),
        "active_share": float(active(there.maps).mean()),
    }


def _alone(trial: Trial, extra: int) -> dict[str, float]:
    """Score a map of one room alone, of initial weights by another seed; nothing where it is not trusted."""
    cmap = blank_map(replace(trial.conditions, seed=trial.conditions.seed + extra))
    cmap.fit(trial.walk.views, trial.walk.odours)
    return Visit.of(cmap, trial).figures if cmap.trusted_ else {}


def _pair(
    one: tuple[str, cells.RateMaps], other: tuple[str, cells.RateMaps], within: float
) -> dict[str, Any]:
    correlation = population_correlation(one[1], other[1])
    return {
        "room": one[0],
        "other_room": other[0],
        "correlation": correlation,
        "remapping_index": 1 - correlation / within,
        "active_in_both": float((active(one[1]) * active(other[1])).mean()),
    }


def changed_rooms(room: Arena) -> dict[str, Arena]:
    """Change one thing in a room, or nothing."""
    boxes = [box.model_dump() for box in room.boxes]
    walls = [wall.model_dump() for wall in room.walls]
    sources = [source.model_dump() for source in room.sources]
    for wall, material in zip(walls, ("mosaic", "marble", "leather", "plaid"), strict=False):
        wall["other"] = material
    repainted = [{**wall, "material": wall["other"]} for wall in walls]
    for wall in (*walls, *repainted):
        del wall["other"]
    mirrored = [{**source, "position": (-source["position"][0], source["position"][1])} for source in sources]
    lamp = Light(azimuth_deg=60.0, elevation_deg=30.0, strength=0.6).model_dump()
    plain = [{**box, "material": "white"} for box in boxes]
    changes: dict[str, dict[str, Any]] = {
        "nothing": {},
        "one box gone": {"boxes": boxes[1:]},
        "all boxes white": {"boxes": plain},
        "one wall": {"walls": [repainted[0], *walls[1:]]},
        "all walls": {"walls": repainted},
        "light from one side": {"light": lamp},
        "smells": {"sources": mirrored},
        "walls and smells": {"walls": repainted, "sources": mirrored},
    }
    return {name: room.model_copy(update=change) for name, change in changes.items()}


def _changed(alone: CognitiveMap, trial: Trial, conditions: Conditions) -> list[dict[str, Any]]:
    """Let the map of one room walk where something is changed, learn on, and compare its cells."""
    before = Visit.of(alone, trial).maps
    rows: list[dict[str, Any]] = []
    for number, (change, room) in enumerate(changed_rooms(trial.conditions.room).items()):
        there = Trial.of(replace(conditions, room=room, seed=conditions.seed + CHANGED_SEED + number))
        grown = deepcopy(alone)
        grown.fit(there.walk.views, there.walk.odours, further=True)
        seen = Visit.of(grown.room(grown.rooms_ - 1), there)
        correlation = population_correlation(before, seen.maps)
        rows.append(
            {
                "change": change,
                "new_room": grown.rooms_ > 1,
                "recognised": Visit.of(alone, there).recognised(0),
                "correlation": correlation,
                "rate_change": rate_change(before, seen.maps),
            }
        )
        same = rows[0]
        index = 1 - correlation / same["correlation"]
        differs = rows[-1]["rate_change"] > RATE * same["rate_change"]
        rows[-1]["remapping_index"] = index
        rows[-1]["remapping"] = "global" if index > GLOBAL else "rate" if differs else "none"
    return rows
