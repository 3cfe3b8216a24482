"""Cue rotation: the walls of a square room turn by 90° and the smells stay; what the cells follow."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pandas as pd

from arena import Arena, Brownian, Camera, Nose, Recording
from cogmap.errors import CogmapError
from cogmap.evaluation.cue_control import CueControl
from cogmap.evaluation.populations import grow_map, perceive, trust_report
from cogmap.experiments import Conditions, Result, experiment
from cogmap.map.activity import Activity
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.plots import plot_examples

PLATFORM, ROOM = 1.5, 2.5
"""Half the side of the platform and of the room, m."""
CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))
SOURCES = ((-1.2, -1.0), (1.2, 0.6), (0.9, -1.2))
"""m; no turn of the room brings them to the same places."""
FAINT = Nose(noise=0.5)
"""Smells so faint that a sniff is off by half."""


class Turn(NamedTuple):
    """A map of a room, and its cells before and after all that is seen there has turned by a quarter."""

    cmap: CognitiveMap
    place: dict[str, CueControl]
    """By what is sensed, as are those of heading."""
    heading: dict[str, CueControl]

    @property
    def correlations(self) -> pd.DataFrame:
        """`CueControl.correlations` of the place cells, a row a cell and what is sensed."""
        return pd.concat(
            [found.correlations.assign(sensed=sensed) for sensed, found in self.place.items()],
            ignore_index=True,
        )

    @property
    def shifts(self) -> pd.DataFrame:
        """How far each head-direction cell has turned, a row a cell and what is sensed."""
        return pd.concat(
            [
                pd.DataFrame({"shift_deg": found.shift_deg, "sensed": sensed})
                for sensed, found in self.heading.items()
            ],
            ignore_index=True,
        )


@experiment(room="open_field", views=17_000, takes=("nose", "motion", "camera", "body", "map"))
def cue_rotation(conditions: Conditions) -> Result:
    """Learn a square room, then turn its walls by a quarter and walk again, in the light and in the dark.

    The walls are of the materials of the first four of the room that is given. A place cell follows the walls
    when its map correlates better with the learnt one turned by a quarter than with the learnt one itself. In
    the light cells fire by sight; with `both` senses smell may contradict it; in the dark place cells fire by
    smell and heading cells not at all, and with `faint` smells a sniff there is off by half.
    `heading_shift_deg` is the median change of the preferred direction, counter-clockwise.
    """
    rooms = square_room(conditions.room, 0), square_room(conditions.room, 1)
    found = turn_what_is_seen(conditions, rooms, PLATFORM)
    heading = found.heading["light"]
    figures = {
        "heading_shift_deg": float(np.median(heading.shift_deg)),
        "heading_follows_walls": heading.directions_follow_sight,
    }
    return Result(
        metrics={
            **{
                f"place_follows_walls_{sensed}": place.maps_follow_sight
                for sensed, place in found.place.items()
            },
            **{
                f"correlation_{sensed}_{cue}": median
                for sensed, place in found.place.items()
                for cue, median in zip(("walls", "smells"), place.median_correlations, strict=True)
            },
            **({} if np.isnan(heading.shift_deg).any() else figures),
            **trust_report(found.cmap),
        },
        tables={"place_cells": found.correlations, "heading_cells": found.shifts},
        figures={
            "examples": plot_examples(
                {
                    "in the light, before": found.place["light"].before,
                    "in the light, walls turned": found.place["light"].after,
                    "in the dark, walls turned": found.place["dark"].after,
                    "heading cells, before": heading.before,
                    "heading cells, walls turned": heading.after,
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


def turn_what_is_seen(conditions: Conditions, rooms: tuple[Arena, Arena], reach: float) -> Turn:
    """Learn the first of two rooms, walk there again, then in the second, which looks turned by a quarter.

    Cells are tuned as far from the origin as `reach` (m).
    """
    walk, *late = (
        replace(conditions, room=rooms[order // 2], seed=conditions.seed + order).explore(
            Brownian(), Camera.panoramic(), fresh=order > 0
        )
        for order in range(3)
    )
    walks = (late[0], late[1])
    cmap = grow_map(walk, conditions.map, seed=conditions.seed)
    before, after = (_by_sense(cmap, item, seed=conditions.seed) for item in walks)
    place, heading = (
        {
            sensed: CueControl.of(
                (getattr(before[sensed], cells), getattr(after[sensed], cells)), walks, reach
            )
            for sensed in before
        }
        for cells in ("place", "heading")
    )
    return Turn(cmap, place, heading)


def _by_sense(cmap: CognitiveMap, walk: Recording, *, seed: int) -> dict[str, Activity]:
    """Let a map look without a nose, look and smell, smell in the dark, and smell what is faint there."""
    odours = walk.require("odours")
    faint = FAINT.smell(odours.astype(float), walk.times, np.random.default_rng(seed))
    return {
        "light": perceive(cmap, walk.views),
        "both": perceive(cmap, walk.views, odours),
        "dark": cmap.perceive(odours=odours),
        "faint": cmap.perceive(odours=faint),
    }
