"""Surprise: a box was moved, one more stands there, one is gone; where, and what if nothing changed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
import shapely
from jaxtyping import Float
from sklearn.metrics import roc_auc_score
from sklearn.utils import gen_batches

from arena import Arena, Brownian, Camera
from arena.rooms.light import Light
from arena.rooms.parts import Box
from cogmap.errors import CogmapError
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.acting.dreamer import Dreamer
from cogmap.imagination.surprise import Surprise
from cogmap.plots import plot_surprise

VIEWS = 500
"""Seen in each changed room."""
UNCHANGED = 10_000
"""Fresh views of the room as it was, at most twice as many as there were to learn from."""
CHANGED_SEED = 2000
"""Added to the seed for walks through changed rooms."""
VISIBLE = 8
"""Difference (grey levels, of the strongest colour) from which on a pixel has changed."""
AWAY = 1.3
"""How far (m) a box is moved."""
SPACE = 0.03
"""Left (m) between a box and what stands beside it."""


@experiment(room="furnished", views=17_000)
def surprise(conditions: Conditions) -> Result:
    """Change one thing in a room that was learnt, and see whether it surprises, and where.

    One box is moved by 1.3 m, another like it added, or it is removed. `auc_*` are over the pixels of 500
    views that are rendered with and without the change: which differ by more than 8 grey levels.
    `located_median_m` is the median over the three of how far the middle of the box is from where all views
    together place the change, NaN where they do not tell that there is one. `false_alarms` are views with any
    pixel above the threshold among `unchanged` ones of fresh walks, and `false_changes` the blocks of 500 of
    these that tell a change together. Kidnapped views are from another room, and where a lamp is out the
    light comes from one side; `*_share` is the median share of pixels that surprise. A room without a box
    beside its platform is given one before it is learnt.
    """
    conditions = replace(conditions, room=with_a_box(conditions.room))
    dreamer = Dreamer.of(conditions)
    camera = Camera.panoramic()
    rooms = changed_rooms(conditions.room)
    rows: list[dict[str, Any]] = []
    shown: dict[str, Any] = {}
    metrics: dict[str, float] = {}
    located: list[float] = []
    for index, (case, (room, boxes)) in enumerate(rooms.items()):
        elsewhere = replace(conditions, room=room, views=VIEWS, seed=conditions.seed + CHANGED_SEED + index)
        walk = elsewhere.explore(Brownian(), camera)
        views, poses = np.asarray(walk.views), walk.require("poses")
        found = dreamer.imagination.surprise(views)
        rows.append(_row(case, found))
        if not boxes:
            continue
        before = camera.render(conditions.room, poses)
        differs = np.abs(before.astype(int) - views).max(axis=3) > VISIBLE
        where = dreamer.metres(found.plan().peak[None])[0] if found.changed else np.full(2, np.nan)
        off = min(float(np.linalg.norm(where - box)) for box in boxes)
        located.append(off)
        metrics[f"auc_{case}"] = float(roc_auc_score(differs.ravel(), found.pixels.ravel()))
        metrics[f"located_{case}_m"] = off
        rows[-1] |= {"auc": metrics[f"auc_{case}"], "located_m": off}
        shown[case] = (room, views, found, where)
    alarms, changes, count = _false_alarms(dreamer, conditions)
    table = pd.DataFrame(rows)
    return Result(
        metrics={
            **metrics,
            "located_median_m": float(np.median(located)),
            "false_alarms": alarms,
            "false_changes": changes,
            "unchanged": count,
            "threshold": dreamer.imagination.threshold,
            "kidnapped_share": float(table.loc[table["case"] == "kidnapped", "share"].iloc[0]),
            "lamp_out_share": float(table.loc[table["case"] == "lamp out", "share"].iloc[0]),
        },
        tables={"cases": table},
        figures={
            f"surprise_{case}": plot_surprise(room, views, found, where, dreamer.metres)
            for case, (room, views, found, where) in shown.items()
        },
        captions={
            f"surprise_{case}": f"A box was {case}: views, what surprises in them, and where all place it"
            for case in shown
        },
    )


def with_a_box(room: Arena) -> Arena:
    """Give a room that has no box beside its platform one, where there is space for it.

    Raises
    ------
    CogmapError
        Where there is none.
    """
    if _beside_platform(room):
        return room
    box = {"center": (0.0, 0.0), "size": (0.4, 0.3), "height": 0.5, "material": "plaid"}
    x0, y0, x1, y1 = room.bounds
    grid = np.stack(np.meshgrid(np.arange(x0, x1, 0.1), np.arange(y0, y1, 0.1)), axis=2).reshape(-1, 2)
    return _changed(room, [*_boxes(room), _placed(room, box, grid)])


def changed_rooms(room: Arena) -> dict[str, tuple[Arena, list[Float[np.ndarray, "2"]]]]:
    """Change one box of a room, in three ways, the light, or the whole room; and tell where boxes changed."""
    boxes, beside = _boxes(room), _beside_platform(room)
    chosen = beside[min(1, len(beside) - 1)]
    box, others = boxes[chosen], [*boxes[:chosen], *boxes[chosen + 1 :]]
    here, angles = np.array(box["center"]), np.arange(0, 2 * np.pi, np.pi / 36)
    around = here + AWAY * np.column_stack([np.cos(angles), np.sin(angles)])
    moved = _placed(room, box, around)
    there = np.array(moved["center"])
    lamp = Light(azimuth_deg=60.0, elevation_deg=30.0, strength=0.6)
    return {
        "moved": (_changed(room, [*others, moved]), [here, there]),
        "added": (_changed(room, [*boxes, moved]), [there]),
        "removed": (_changed(room, others), [here]),
        "kidnapped": (Arena.load("l_shape" if room.name == "two_rooms" else "two_rooms"), []),
        "lamp out": (room.model_copy(update={"light": lamp.model_dump()}), []),
    }


def _placed(room: Arena, box: dict[str, Any], places: Float[np.ndarray, "places 2"]) -> dict[str, Any]:
    """Put a box at the first place where it fits between the walls, the platform and what stands there."""
    inside = shapely.box(*room.bounds)
    taken = shapely.union_all([room.walkable, room.obstacles])
    for place in places:
        put = {**box, "center": tuple(place.tolist())}
        outline = shapely.Polygon(Box(**put).outline)
        if inside.contains(outline) and outline.distance(taken) > SPACE:
            return put
    raise CogmapError(
        f"there is no place for a box beside the platform of {room.name!r}; choose another room"
    )


def _beside_platform(room: Arena) -> list[int]:
    outlines = [shapely.Polygon(box.outline) for box in room.boxes]
    return [index for index, outline in enumerate(outlines) if not room.walkable.intersects(outline)]


def _boxes(room: Arena) -> list[dict[str, Any]]:
    return [box.model_dump() for box in room.boxes]


def _changed(room: Arena, boxes: list[dict[str, Any]]) -> Arena:
    return room.model_copy(update={"boxes": boxes})


def _row(case: str, found: Surprise) -> dict[str, Any]:
    """Say of a case how often it alarms, and how much of a view surprises then."""
    return {
        "case": case,
        "views": len(found.pixels),
        "alarmed": float(found.alarms.mean()),
        "share": float(np.median(found.shares)),
    }


def _false_alarms(dreamer: Dreamer, conditions: Conditions) -> tuple[int, int, int]:
    """Count views that alarm where nothing has changed, blocks that tell a change, and the views seen."""
    count = min(UNCHANGED, 2 * conditions.views)
    more = replace(conditions, seed=conditions.seed + CHANGED_SEED)
    alarms = changes = seen = 0
    for walk in (dreamer.trial.fresh, more.explore(Brownian(), Camera.panoramic(), fresh=True)):
        for rows in gen_batches(min(len(walk), count - seen), VIEWS):
            found = dreamer.imagination.surprise(np.asarray(walk.views[rows]))
            alarms += int(found.alarms.sum())
            changes += found.changed
        seen += min(len(walk), count - seen)
    return alarms, changes, seen
