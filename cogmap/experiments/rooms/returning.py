"""Returning: how much of the first room is forgotten while others are learnt."""

from __future__ import annotations

from typing import Any

import pandas as pd

from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.rooms.many_rooms import (
    Visit,
    blank_map,
    house_of,
    population_correlation,
)
from cogmap.plots import plot_forgetting


@experiment(room="furnished", views=8000, any_room=False, takes=("nose", "motion", "camera", "body", "map"))
def returning(conditions: Conditions) -> Result:
    """Come back to a room after learning ever more others, and see what is left of its map: forgetting.

    After each room the map looks at the same fresh walk through the first one, without learning from it.
    `forgotten_heading_deg` and `forgotten_position_m` are by how much its errors have grown when ten rooms
    are known; `room_recognised` is the least share of the views that are taken for the first room. At the
    end the explorer returns for as many views as it learnt from, and learns on: `returned_*` are its errors
    then, and `rooms` how many rooms the map holds, which is ten if it knew the room again.
    """
    trials = house_of(conditions)
    cmap, rows = blank_map(conditions), []
    maps = None
    for number, trial in enumerate(trials, start=1):
        cmap.fit(trial.walk.views, trial.walk.odours, further=True, progress=conditions.progress)
        there = Visit.of(cmap, trials[0])
        maps = maps or there.maps
        rows.append({"rooms": number, **_row(there), "correlation": population_correlation(maps, there.maps)})
    walk = trials[0].walk
    cmap.partial_fit(walk.views, walk.odours, jump=True)
    returned = _row(Visit.of(cmap, trials[0]))
    table = pd.DataFrame(rows)
    first, last = table.iloc[0], table.iloc[-1]
    return Result(
        metrics={
            "rooms": cmap.rooms_,
            "forgotten_heading_deg": float(last["heading_median_deg"] - first["heading_median_deg"]),
            "forgotten_position_m": float(last["position_median_m"] - first["position_median_m"]),
            "room_recognised": float(table["recognised"].min()),
            "return_correlation": float(last["correlation"]),
            "returned_heading_deg": returned["heading_median_deg"],
            "returned_position_m": returned["position_median_m"],
        },
        tables={"rooms": table},
        figures={"forgetting": plot_forgetting(table)},
        captions={"forgetting": "Errors in the first room while ever more others are learnt"},
    )


def _row(there: Visit) -> dict[str, Any]:
    figures = there.figures
    return {
        "heading_median_deg": figures.get("heading_median_deg", float("nan")),
        "position_median_m": figures["position_median_m"],
        "recognised": there.recognised(0),
    }
