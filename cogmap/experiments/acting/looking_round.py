"""Looking round: turning one's head just a little tells apart places that look alike, or never will."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float, UInt8

from arena import Arena, Brownian, Camera, Disc
from arena.acting import journeys
from cogmap.control.look_round import LookRound
from cogmap.experiments import Conditions, Result, experiment, pose_columns
from cogmap.experiments.paper.distinguishability import opposite, pose_distances
from cogmap.features.image_codes import image_codes
from cogmap.navigation.hypotheses import SceneMemory
from cogmap.plots import plot_looking_round

ROOMS = {"blue_wall": "blue_wall", "white": "white_rectangle"}
TURN = np.deg2rad(6)
"""From look to look, rad."""
QUERIES = 500
"""Poses that it is put at, in each room."""
DT, LOOKS = 0.2, 5
"""Time from look to look, s, and looks to either side."""


class _Looked(NamedTuple):
    table: pd.DataFrame
    views: UInt8[np.ndarray, "4 height width 3"]
    """The first look of one, what it takes that for, its last look, and what it takes that for."""


@experiment(room="blue_wall", views=17_000, any_room=False)
def looking_round(conditions: Conditions) -> Result:
    """Turn the head where a view may have been taken at either of two places, until one hypothesis stands.

    An eye of 90 degrees sees no more than a part of a white room, of which one wall may be blue. The animal
    remembers views and smells of a walk; then it is put somewhere and looks, without smelling. It is right
    when the view that it takes this for was taken nearer to where it is than to the opposite pose: before
    turning, and after turns of 6 degrees, up to 30 to either side, whether it says that it knows
    (`resolved`) or not. In the white room nothing could tell, and it must not say that it knows.
    """
    looked = {name: _look(conditions, Arena.load(room)) for name, room in ROOMS.items()}
    metrics: dict[str, float] = {}
    for name, (table, *_) in looked.items():
        known = table["resolved"]
        metrics |= {
            f"{name}_share_right_before": float(table["right_before"].mean()),
            f"{name}_share_right_after": float(table["right_after"].mean()),
            f"{name}_share_resolved": float(known.mean()),
            f"{name}_resolved_and_wrong": int((known & ~table["right_after"]).sum()),
            f"{name}_turned_median_deg": float(table["turned_deg"].median()),
        }
    return Result(
        metrics={"queries": QUERIES, **metrics},
        tables={name: each.table for name, each in looked.items()},
        figures={
            "looking_round": plot_looking_round(
                {name: (each.table, each.views) for name, each in looked.items()}
            )
        },
        captions={
            "looking_round": "Taken for the right place, or the opposite, before and after looking round"
        },
    )


def _look(conditions: Conditions, room: Arena) -> _Looked:
    camera, body = Camera.perspective(80, 60), Disc()
    here = replace(conditions, room=room)
    walk = here.explore(Brownian(), camera)
    fresh = here.explore(Brownian(), camera, fresh=True).require("poses")
    starts = fresh[np.unique(np.linspace(0, len(fresh) - 1, QUERIES).astype(int))]
    memory = SceneMemory(image_codes(walk.views), np.log(walk.require("odours")))
    turn = np.array([0.0, TURN / (DT * body.max_turn)])
    policy = LookRound(memory, turn, looks=LOOKS)
    gone = journeys(room, policy, camera, starts, body=body, dt=DT, most_steps=20, seed=conditions.seed)
    ends, poses = gone.poses[-1], walk.require("poses")
    first, last = policy.first_views_, policy.views_
    aside = np.where(policy.looks_ > LOOKS + 1, policy.looks_ - LOOKS, policy.looks_) - 1
    table = pd.DataFrame(
        {
            **pose_columns(starts),
            **pose_columns(poses[first], "before_"),
            **pose_columns(poses[last], "after_"),
            "right_before": _right(room, poses[first], starts),
            "right_after": _right(room, poses[last], ends),
            "resolved": policy.resolved_,
            "turned_deg": np.rad2deg(TURN) * aside,
        }
    )
    # one that changed its mind, if there is one
    one = int((~table["right_before"] & table["right_after"]).argmax())
    seen = camera.render(room, np.stack([starts[one], ends[one]]))
    remembered = [np.asarray(walk.views[view]) for view in (first[one], last[one])]
    return _Looked(table, np.stack([seen[0], remembered[0], seen[1], remembered[1]]))


def _right(
    room: Arena, taken: Float[np.ndarray, "queries 3"], truth: Float[np.ndarray, "queries 3"]
) -> Bool[np.ndarray, "queries"]:
    """Whether each is nearer to its own pose than to the opposite."""
    right: np.ndarray = pose_distances(taken, truth) <= pose_distances(taken, opposite(room, truth))
    return right
