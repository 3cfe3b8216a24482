"""Reaching: to the pose of an image, through the physics, by commands whose effect is learnt."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pandas as pd
from jaxtyping import Float, UInt8

from arena import Brownian, Camera, Disc, Recording
from arena.angles import wrap_angle
from arena.eye.base import Eye
from cogmap.control import Outcome, Reacher, Reaching
from cogmap.control.percept import Percept, Views
from cogmap.control.steering import Steering
from cogmap.errors import CogmapError
from cogmap.evaluation.peers.image_descent import ImageDescent, catchment, rotational_difference
from cogmap.evaluation.peers.true_pose import PoseEye, TruePercept
from cogmap.evaluation.populations import grow_map, trust_report
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.acting.travels import (
    babble,
    draw_poses,
    noisy,
    scored,
    summary,
    travel,
)
from cogmap.map.activity import Activity
from cogmap.map.cognitive_map import CognitiveMap
from cogmap.navigation.place_graph import PlaceGraph
from cogmap.plots import plot_catchment, plot_journeys, plot_reached
from cogmap.plots.acting.catchment import Field

PAIRS, DISTURBED = 200, 100
"""Starts and goals: in peace, and under each disturbance and by each peer."""
GRID, SNAPSHOTS = 0.2, 3
"""Cells of the catchment maps, m, and how many goals have one."""

_Ends = tuple[Float[np.ndarray, "pairs 3"], Float[np.ndarray, "pairs 3"]]
"""Starts and goals."""
DISTURBANCES: dict[str, tuple[Disc, float]] = {
    "slip": (Disc(slip=0.05), 0.01),
    "swapped": (Disc(swapped=True), 0.0),
    "weak": (Disc(wheel_gains=(0.7, 1.0)), 0.0),
    "delayed": (Disc(delay=0.2), 0.0),
}
"""Bodies, and the noise of their eye: slipping wheels, swapped ones, a weak one, late commands."""


class _PlainPercept(NamedTuple):
    """What the charts alone tell, as if the map had never been refined."""

    cmap: CognitiveMap

    def perceive(self, views: Views) -> Activity:
        seen = self.cmap.perceive(views)
        return replace(seen if seen.plain is None else seen.plain, novelty=seen.novelty)

    def turns(self, views: Views, others: Views) -> Float[np.ndarray, "views"]:
        return wrap_angle(self.perceive(others).phase - self.perceive(views).phase)


@experiment(room="pillar", views=17_000, takes=("map",))
def reaching(conditions: Conditions) -> Result:
    """Reach the pose of an image through the physics, by what babbling taught of commands, beside peers.

    A map is learnt and its places are relaxed from one walk; the body babbles 400 decisions of 0.2 s, from
    which it learns what commands do; then 200 explorers are shown an image each, and go where it was taken,
    until they say that they have arrived. Poses draw starts and goals and score the ends: nothing that acts
    is told one. `slip_`: wheels slip by 5 %, and images have 1 % noise; `swapped_`: each wheel has the
    other's command; `weak_`: one wheel turns 70 % as fast as told; `delayed_`: commands act 0.2 s late; for
    each the body babbles anew. `true_`: the same policy with an eye that sees the pose itself; `plain_`: with
    what the charts alone perceive; `descent_`: descent on the rotational image difference, which has no map.
    `nearest_view_median_m` is how far the remembered view lies that looks most like a goal.
    """
    room, camera, body = conditions.room, Camera.panoramic(), Disc()
    walk = conditions.explore(Brownian(), camera)
    cmap = grow_map(walk, conditions.map, seed=conditions.seed, progress=conditions.progress)
    cmap.refine(walk.views)
    if cmap.relaxed_places_ is None:
        raise CogmapError(f"nothing reaches anything with this map: {cmap.refine_reason_}; explore more")
    rng = np.random.default_rng(conditions.seed)
    starts, goals = (draw_poses(room, body.radius, PAIRS, rng) for _ in range(2))
    images = camera.render(room, goals)
    few = starts[:DISTURBED], goals[:DISTURBED]
    motor = babble(room, camera, cmap, body, conditions.seed)
    reacher = Reacher(cmap, motor)
    go = reacher.towards(images)
    gone = travel(room, go, camera, starts, body=body, seed=conditions.seed)
    tables = {"": scored(room, gone, goals, body).assign(outcome=_names(go))}
    for name, (other, noise) in DISTURBANCES.items():
        eye = noisy(camera, noise)
        learnt = babble(room, eye, cmap, other, conditions.seed)
        seen = eye.render(room, few[1], rng=rng)
        steers = Reacher(cmap, learnt).towards(seen)
        late = travel(room, steers, eye, few[0], body=other, seed=conditions.seed)
        tables[f"{name}_"] = scored(room, late, few[1], other).assign(outcome=_names(steers))
    tables |= _peers(conditions, cmap, walk, few, camera)
    metrics = {
        f"{name}{key}": value for name, table in tables.items() for key, value in summary(table).items()
    }
    nearest = cmap.relaxed_places_.nearest(images)
    caught, fields = _catchments(conditions, reacher, camera, goals[:SNAPSHOTS], images[:SNAPSHOTS])
    return Result(
        metrics={
            "pairs": PAIRS,
            **metrics,
            "nearest_view_median_m": float(
                np.median(np.linalg.norm(walk.require("poses")[nearest, :2] - goals[:, :2], axis=1))
            ),
            **caught,
            **trust_report(cmap),
        },
        tables={
            "journeys": pd.concat(
                [
                    table.assign(condition=name.removesuffix("_") or "in peace")
                    for name, table in tables.items()
                ],
                ignore_index=True,
            )
        },
        figures={
            "journeys": plot_journeys(room, gone, goals, images, camera),
            "reached": plot_reached({name.removesuffix("_") or "in peace": t for name, t in tables.items()}),
            "catchment": plot_catchment(room, fields),
        },
        captions={
            "journeys": "Journeys to the poses of images, and what is seen on the way of one",
            "reached": "How far from the goal each journey ended, under disturbances and beside peers",
            "catchment": "From where descent on image differences reaches a goal, and from where the policy",
        },
    )


def _peers(
    conditions: Conditions, cmap: CognitiveMap, walk: Recording, ends: _Ends, camera: Camera
) -> dict[str, pd.DataFrame]:
    """Let others go the same ways: by the truth, by what charts alone perceive, by image differences."""
    room, body, (starts, goals) = conditions.room, Disc(), ends
    truth, eye = TruePercept(), PoseEye()
    rng = np.random.default_rng(conditions.seed)
    plain = _PlainPercept(cmap)
    known = {"true_": walk.require("poses")[:, :2], "plain_": plain.perceive(walk.views).position}
    sees: dict[str, tuple[Percept, Eye]] = {"true_": (truth, eye), "plain_": (plain, camera)}
    tables = {}
    for name, (percept, looks) in sees.items():
        motor = babble(room, looks, percept, body, conditions.seed)
        images = looks.render(room, goals, rng=rng)
        go = Reaching(percept, PlaceGraph(known[name].astype(np.float64)), Steering(motor), images)
        gone = travel(room, go, looks, starts, body=body, seed=conditions.seed)
        tables[name] = scored(room, gone, goals, body).assign(outcome=_names(go))
    steering = Steering(babble(room, eye, truth, body, conditions.seed))
    descent = ImageDescent(camera.render(room, goals), steering)
    gone = travel(room, descent, camera, starts, body=body, seed=conditions.seed)
    return tables | {"descent_": scored(room, gone, goals, body)}


def _catchments(
    conditions: Conditions,
    reacher: Reacher,
    camera: Camera,
    goals: Float[np.ndarray, "goals 3"],
    images: UInt8[np.ndarray, "goals height width 3"],
) -> tuple[dict[str, float], list[Field]]:
    """Map from where each goal is reached: by steepest descent on image differences, and by the policy."""
    room, body = conditions.room, Disc()
    x0, y0, x1, y1 = room.walkable.bounds
    x, y = np.arange(x0 + GRID / 2, x1, GRID), np.arange(y0 + GRID / 2, y1, GRID)
    places = np.stack(np.meshgrid(x, y), axis=-1)
    free = room.is_free(places.reshape(-1, 2), body.radius + 0.01).reshape(places.shape[:2])
    starts = np.column_stack([places[free], np.zeros(free.sum())])
    seen, fields = camera.render(room, starts), []
    for goal, image in zip(goals, images, strict=True):
        difference, ended = (np.full(free.shape, np.nan) for _ in range(2))
        difference[free] = rotational_difference(seen, np.broadcast_to(image, seen.shape)).rms
        column, row = np.floor((goal[:2] - [x0, y0]) / GRID).astype(int).tolist()
        go = reacher.towards(np.broadcast_to(image, seen.shape))
        gone = travel(room, go, camera, starts, body=body, seed=conditions.seed)
        ended[free] = np.linalg.norm(gone.poses[-1, :, :2] - goal[:2], axis=1)
        fields.append(Field(goal, (x0, y0), GRID, difference, catchment(difference, (row, column)), ended))
    shares = {
        "descent_catchment": np.mean([field.caught[free].mean() for field in fields]),
        "catchment": np.mean([(field.ended_m[free] <= 0.05).mean() for field in fields]),
    }
    return {name: float(share) for name, share in shares.items()}, fields


def _names(policy: Reaching) -> list[str]:
    return [Outcome(outcome).name.lower() for outcome in policy.outcomes_]
