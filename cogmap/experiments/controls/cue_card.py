"""Cue card: one card on a wall that is the same all round turns by 90°; what the cells follow."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
import shapely
from shapely.affinity import rotate

from arena import Arena
from cogmap.cells import Tuning
from cogmap.errors import CogmapError
from cogmap.evaluation.cue_control import CueControl
from cogmap.evaluation.populations import trust_report
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.controls.cue_rotation import Turn, turn_what_is_seen
from cogmap.plots import plot_cue_control, plot_examples


@experiment(
    room="cue_square",
    views=17_000,
    takes=("nose", "motion", "camera", "body", "map"),
    extra_rooms=("cue_cylinder",),
)
def cue_card(conditions: Conditions) -> Result:
    """Learn a room with one cue card, then turn the card by a quarter; the smells stay.

    As in the recordings of Muller & Kubie (1987) and Taube et al. (1990), whose place cells and
    head-direction cells turned with the card. The same walks are sensed by sight alone (`light`), by smell
    alone (`dark`) and by smells so `faint` that a sniff is off by half. A place cell follows the
    card when its map correlates better with the first one turned by a quarter than with the first one itself;
    `heading_shift_deg` is the median change of the preferred direction, counter-clockwise. In the dark
    head-direction cells are silent: nothing here integrates turns, as the animals of Goodridge & Taube do.

    References
    ----------
    Muller & Kubie (1987), The effects of changes in the environment on the spatial firing of hippocampal
    complex-spike cells. J. Neurosci. 7.
    Taube, Muller & Ranck (1990), Head-direction cells recorded from the postsubiculum in freely moving rats.
    II. Effects of environmental manipulations. J. Neurosci. 10.
    Goodridge, Dudchenko, Worboys, Golob & Taube (1998), Cue control and head direction cells. Behav.
    Neurosci. 112.
    """
    rooms = (conditions.room, *conditions.extra_rooms)
    found = {room.name: _visit(replace(conditions, room=room)) for room in rooms}
    place, heading = (
        pd.concat([getattr(turn, part).assign(arena=name) for name, turn in found.items()], ignore_index=True)
        for part in ("correlations", "shifts")
    )
    return Result(
        metrics={name: _figures(turn) for name, turn in found.items()},
        tables={"place_cells": place, "heading_cells": heading},
        figures={
            "follows": plot_cue_control(place, heading),
            **{f"examples_{name}": plot_examples(_examples(turn)) for name, turn in found.items()},
        },
        captions={
            "follows": "What each cell follows when the card turns, by what is sensed",
            **{
                f"examples_{name}": f"Six cells of each population in {name}, before and after"
                for name in found
            },
        },
    )


def with_card_turned(room: Arena) -> Arena:
    """Turn all boxes and blocks of a room by a quarter about the origin, and leave walls and smells.

    Raises
    ------
    CogmapError
        For a room without any, or whose platform a quarter turn changes.
    """
    if not (room.boxes or room.blocks):
        raise CogmapError(f"room {room.name!r} has no box or block for a card; give it one")
    if not rotate(room.walkable, 90, (0, 0)).equals_exact(room.walkable, 1e-6, normalize=True):
        raise CogmapError(f"a quarter turn of {room.name!r} is not itself; centre a square or round platform")
    boxes = [
        box.model_copy(update={"center": _turned(box.center), "angle_deg": box.angle_deg + 90})
        for box in room.boxes
    ]
    blocks = [
        block.model_copy(update={"corners": tuple(map(_turned, block.corners))}) for block in room.blocks
    ]
    return room.model_copy(
        update={
            "name": f"{room.name}_turned",
            "boxes": [box.model_dump() for box in boxes],
            "blocks": [block.model_dump() for block in blocks],
        }
    )


def _turned(point: tuple[float, float]) -> tuple[float, float]:
    return -point[1], point[0]


def _visit(conditions: Conditions) -> Turn:
    room = conditions.room
    reach = float(np.abs(shapely.bounds(room.walkable)).max())
    return turn_what_is_seen(conditions, (room, with_card_turned(room)), reach)


def _figures(turn: Turn) -> dict[str, Any]:
    """Tell what both populations follow, by what is sensed; nothing of heading cells that are silent."""
    return {
        **trust_report(turn.cmap),
        **{sensed: _followed(place, turn.heading[sensed]) for sensed, place in turn.place.items()},
    }


def _followed(place: CueControl, heading: CueControl) -> dict[str, float]:
    card, smells = place.median_correlations
    figures = {
        "place_follows_card": place.maps_follow_sight,
        "correlation_card": card,
        "correlation_smells": smells,
    }
    if np.isnan(heading.shift_deg).any():
        return figures
    shift = float(np.median(heading.shift_deg))
    return {**figures, "heading_follows_card": heading.directions_follow_sight, "heading_shift_deg": shift}


def _examples(turn: Turn) -> dict[str, Tuning]:
    light, heading = turn.place["light"], turn.heading["light"]
    return {
        "in the light, before": light.before,
        "in the light, card turned": light.after,
        "in the dark, card turned": turn.place["dark"].after,
        "heading cells, before": heading.before,
        "heading cells, card turned": heading.after,
    }
