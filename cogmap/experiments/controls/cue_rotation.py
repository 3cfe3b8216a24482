"""Cue rotation: the walls of a square room turn by 90° and the smells stay; what the cells follow."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
from jaxtyping import Float

from arena import Arena, Brownian, Camera, Recording
from cogmap.cells import RateMaps, Tuning, bin_edges, mean_vectors, rate_maps, tuning_curves
from cogmap.errors import CogmapError
from cogmap.evaluation.ground_truth import map_correlations
from cogmap.evaluation.populations import grow_map, perceive, trust_report
from cogmap.experiments import Conditions, Result, experiment
from cogmap.plots import plot_examples

PLATFORM, ROOM = 1.5, 2.5
"""Half the side of the platform and of the room, m."""
CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))
SOURCES = ((-1.2, -1.0), (1.2, 0.6), (0.9, -1.2))
"""m; no turn of the room brings them to the same places."""


@experiment(room="open_field", views=17_000, takes=("nose", "motion", "camera", "body", "map"))
def cue_rotation(conditions: Conditions) -> Result:
    """Learn a square room, then turn its walls by a quarter and walk again, in the light and in the dark.

    The walls are of the materials of the first four of the room that is given. A place cell follows the walls
    when its map correlates better with the learnt one turned by a quarter than with the learnt one itself. In
    the light cells fire by sight, in the dark place cells by smell and heading cells not at all;
    `heading_shift_deg` is the median change of the preferred direction, counter-clockwise.
    """
    camera = Camera.panoramic()
    rooms = {turns: square_room(conditions.room, turns) for turns in (0, 1)}
    walk, before, after = (
        replace(conditions, room=rooms[turns], seed=conditions.seed + late).explore(
            Brownian(), camera, fresh=late > 0
        )
        for turns, late in ((0, 0), (0, 1), (1, 2))
    )
    cmap = grow_map(walk, conditions.map, seed=conditions.seed)
    lit = [perceive(cmap, item.views) for item in (before, after)]
    dark = [cmap.perceive(odours=item.odours) for item in (before, after)]
    place = {
        "light": [_tuning(lit[0].place, before), _tuning(lit[1].place, after)],
        "dark": [_tuning(dark[0].place, before), _tuning(dark[1].place, after)],
    }
    heading = [_tuning(lit[0].heading, before), _tuning(lit[1].heading, after)]
    table = pd.DataFrame(
        {
            f"{name}_{cue}": map_correlations(turned(cells[0].maps, turns), cells[1].maps)
            for name, cells in place.items()
            for cue, turns in (("walls", 1), ("smells", 0))
        }
    )
    follows = pd.DataFrame({name: table[f"{name}_walls"] > table[f"{name}_smells"] for name in place})
    shift = np.rad2deg(np.angle(mean_vectors(heading[1].curves) * mean_vectors(heading[0].curves).conj()))
    figures = {
        "heading_shift_deg": float(np.median(shift)),
        "heading_follows_walls": float((abs(shift - 90) < 45).mean()),
    }
    return Result(
        metrics={
            **{f"place_follows_walls_{name}": float(share) for name, share in follows.mean().items()},
            **{f"correlation_{name}": float(found) for name, found in table.median().items()},
            **({} if np.isnan(shift).any() else figures),
            **trust_report(cmap),
        },
        tables={"place_cells": table, "heading_cells": pd.DataFrame({"shift_deg": shift})},
        figures={
            "examples": plot_examples(
                {
                    "in the light, before": place["light"][0],
                    "in the light, walls turned": place["light"][1],
                    "in the dark, walls turned": place["dark"][1],
                    "heading cells, before": heading[0],
                    "heading cells, walls turned": heading[1],
                }
            )
        },
        captions={"examples": "Six cells of each population before and after the walls have turned"},
    )


def square_room(room: Arena, turns: int) -> Arena:
    """Build a square room with the first four wall materials of a room, turned by so many quarters.

    Raises
    ------
    CogmapError
        For a room with fewer walls.
    """
    materials = [wall.material for wall in room.walls[:4]]
    if len(materials) < 4:
        raise CogmapError(f"room {room.name!r} has {len(materials)} walls; a square room takes four")
    corners = [(ROOM * x, ROOM * y) for x, y in CORNERS]
    walls = [
        {"start": corners[side], "end": corners[(side + 1) % 4], "material": materials[(side - turns) % 4]}
        for side in range(4)
    ]
    return Arena.create(
        name=f"square_{90 * turns}",
        platform=[[(PLATFORM * x, PLATFORM * y) for x, y in CORNERS]],
        walls=walls,
        sources=[{"position": place} for place in SOURCES],
    )


def turned(maps: RateMaps, turns: int) -> RateMaps:
    """Turn square maps by so many quarters counter-clockwise."""
    # Row 0 is the lowest y, so that numpy's quarter turns go the other way.
    return RateMaps(np.rot90(maps.rates, -turns, axes=(1, 2)), np.rot90(maps.occupancy, -turns), maps.edges)


def _tuning(rates: Float[np.ndarray, "views cells"], walk: Recording) -> Tuning:
    """Rate maps and tuning curves; a cell without a compass, of rate NaN, is silent."""
    rates, poses = np.nan_to_num(rates), walk.require("poses")
    edges = bin_edges(PLATFORM * np.array(CORNERS, dtype=float))
    return Tuning(rate_maps(rates, poses[:, :2], edges=edges), tuning_curves(rates, poses[:, 2]))
