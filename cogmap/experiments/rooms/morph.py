"""Morph: the materials of one known room are blended into those of another, and cells switch between maps."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float, UInt8

from arena import Arena, Camera, Recording
from cogmap.cells.decoding.decoders import fit_heading_frame, heading_errors
from cogmap.errors import CogmapError
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.rooms.many_rooms import Visit, blank_map, population_correlation, trials_of
from cogmap.experiments.trial import Trial
from cogmap.map.activity import Activity
from cogmap.plots import plot_morph

MATERIALS = {"brick": "mosaic", "timber": "marble", "tiles": "leather", "granite": "plaid"}
"""Of the walls, there and in the other room;"""
BOX_MATERIALS = ("blue", "books", "white", "tiles", "timber")
"""those of its boxes, in turn."""
STEPS = 10
SEEDS = 3
"""Walks, maps and curves."""
SWITCHED = 0.2
"""Least rise of a curve that switches."""
NEAR_DEG = 15.0
"""A heading follows a room's compass when it is off by less."""


@experiment(room="furnished", views=8000, takes=("nose", "motion", "body", "map"))
def morph(conditions: Conditions) -> Result:
    """Learn two rooms that differ in all materials, then see blends of both: where place and heading switch.

    The rooms have the same walls, boxes and smells. A blend is of the images of both at the same poses, in
    ten steps, perceived by sight alone, with nothing learnt from it; three seeds give the spread of each
    curve. `place` is how much better the population vectors of place cells fit the map of the second room
    than that of the first, from −1 to 1 as their correlations differ; `heading` the same of the shares of
    views whose heading is right by less than 15° in the compass of either. `room` is the share of views
    that are taken for the second room, `confidence` how sure the map is of either, and `nowhere` the share of
    those taken for neither. A width is the part of the way from room to room (0 to 1) from a tenth to
    nine tenths of the switch, linear between steps; `switch_at_*` is its middle.

    References
    ----------
    Wills, Lever, Cacucci, Burgess & O'Keefe (2005), Attractor dynamics in the hippocampal representation of
    the local environment. Science 308.
    Leutgeb et al. (2005), Progressive transformation of hippocampal neuronal representations in 'morphed'
    environments. Neuron 48.
    """
    rows: list[dict[str, Any]] = []
    reasons = []
    for seed in range(conditions.seed, conditions.seed + SEEDS):
        pair = _Pair.of(replace(conditions, seed=seed))
        reasons.append(pair.reason)
        rows += [{"seed": seed, **row} for row in pair.curve()]
    curves = pd.DataFrame(rows)
    return Result(
        metrics={
            "trusted": not any(reasons),
            "reason": "; ".join(filter(None, reasons)),
            **_switches(curves),
            "least_confidence": float(curves.groupby("blend")["confidence"].mean().min()),
            "most_nowhere": float(curves.groupby("blend")["nowhere"].mean().max()),
        },
        tables={"curves": curves},
        figures={"morph": plot_morph(curves)},
        captions={"morph": "What both populations and the recognised room follow in blends of two rooms"},
    )


CURVES = ("place", "heading", "room")


def repainted(room: Arena) -> Arena:
    """Paint the walls and boxes of a room with other materials.

    Raises
    ------
    CogmapError
        For a room without walls to paint.
    """
    if not room.walls:
        raise CogmapError(f"room {room.name!r} has no walls to paint; choose another room")
    walls, boxes = ([part.model_dump() for part in parts] for parts in (room.walls, room.boxes))
    others = [*MATERIALS.values()]
    for number, wall in enumerate(walls):
        wall["material"] = MATERIALS.get(str(wall["material"]), others[number % len(others)])
    for number, box in enumerate(boxes):
        box["material"] = BOX_MATERIALS[number % len(BOX_MATERIALS)]
    return room.model_copy(update={"name": f"{room.name}_repainted", "walls": walls, "boxes": boxes})


def blended(
    one: UInt8[np.ndarray, "views height width 3"],
    other: UInt8[np.ndarray, "views height width 3"],
    share: float,
) -> UInt8[np.ndarray, "views height width 3"]:
    """Blend images of the same poses, the other with the given share."""
    mixed = (1 - share) * one.astype(np.float32) + share * other.astype(np.float32)
    return np.rint(mixed).astype(np.uint8)


@dataclass(frozen=True, eq=False)
class _Pair:
    """A map of two rooms, what it makes of each, and the same fresh poses seen in both."""

    visits: tuple[Visit, Visit]
    images: tuple[UInt8[np.ndarray, "views height width 3"], UInt8[np.ndarray, "views height width 3"]]
    walk: Recording
    cmap: Any

    @classmethod
    def of(cls, conditions: Conditions) -> _Pair:
        """Learn both rooms."""
        rooms = conditions.room, repainted(conditions.room)
        trials = trials_of(conditions, list(rooms))
        cmap = blank_map(conditions)
        for trial in trials:
            cmap.fit(trial.walk.views, trial.walk.odours, further=True)
        walk = trials[0].fresh
        eye = Camera.panoramic()
        images = tuple(np.asarray(eye.render(room, walk.require("poses"))) for room in rooms)
        one, other = (Visit.of(cmap, trial) for trial in trials)
        return cls((one, other), (images[0], images[1]), walk, cmap)

    @property
    def reason(self) -> str:
        """Why the map is not to be trusted."""
        known = "" if self.cmap.rooms_ == 2 else f"the map holds {self.cmap.rooms_} rooms, not 2"
        return self.cmap.reason_ or known

    def curve(self) -> list[dict[str, Any]]:
        """Tell of each blend what the cells follow."""
        rows = []
        for share in np.linspace(0, 1, STEPS + 1):
            views = replace(self.walk, views=blended(*self.images, float(share)))
            seen = Visit.of(self.cmap, self.visits[0].trial, views)
            maps, there = seen.maps, seen.test
            fits = [population_correlation(maps, visit.maps) for visit in self.visits]
            right = [self._right(there, visit.trial, visit.train) for visit in self.visits]
            rows.append(
                {
                    "blend": float(share),
                    "place": fits[1] - fits[0],
                    "heading": right[1] - right[0],
                    "room": float(np.mean(there.room == 1)),
                    "nowhere": float(np.mean(there.room == -1)),
                    "confidence": float(np.mean(np.asarray(there.room_confidence))),
                }
            )
        return rows

    def _right(self, seen: Activity, trial: Trial, train: Activity) -> float:
        """Share of views whose heading is right in the compass of a room; none where there is none."""
        if not (np.isfinite(seen.phase).all() and np.isfinite(train.phase).all()):
            return 0.0
        frame = fit_heading_frame(train.phase, trial.truth.train[:, 2])
        off = np.abs(heading_errors(seen.phase, self.walk.require("poses")[:, 2], frame))
        return float(np.mean(np.rad2deg(off) < NEAR_DEG))


def _switches(curves: pd.DataFrame) -> dict[str, float]:
    """Middle and width of each switch, means over the seeds, and how much widths differ between these."""
    figures = {}
    for what in CURVES:
        found = [_switch(each, what) for _, each in curves.groupby("seed")]
        if None not in found:
            middle, width = np.array(found, float).T
            figures[f"switch_at_{what}"] = float(middle.mean())
            figures[f"switch_width_{what}"] = float(width.mean())
            figures[f"switch_width_{what}_spread"] = float(width.std(ddof=1))
    return figures


def _switch(curve: pd.DataFrame, what: str) -> tuple[float, float] | None:
    """Find the blend in the middle of a switch, and its width from a tenth to nine tenths, between steps.

    None where the curve ends near where it begins: nothing has switched.
    """
    level: Float[np.ndarray, "steps"] = curve[what].to_numpy(float)
    if not level[-1] - level[0] > SWITCHED:
        return None
    # as far as it has come: where a curve falls back a little it has not switched back
    done = np.maximum.accumulate((level - level[0]) / (level[-1] - level[0]))
    early, middle, late = np.interp([0.1, 0.5, 0.9], done, curve["blend"].to_numpy(float))
    return float(middle), float(late - early)
