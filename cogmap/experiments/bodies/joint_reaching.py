"""Reaching with an arm: postures given as images, through the motors, without and with obstacles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from jaxtyping import Float
from matplotlib.figure import Figure

from arena import Arena, Arm, Babble, Recording
from arena.acting import Journeys, journeys
from arena.angles import wrap_angle
from arena.eye.base import AnyEye, see
from arena.rooms.parts import Box
from cogmap.control import Outcome, PostureReacher
from cogmap.coordinates.view_code import ViewCode
from cogmap.evaluation.joint_ways import joint_length, shortest_joint_ways, ways_are_free
from cogmap.evaluation.peers.prm import prm_joint_paths
from cogmap.experiments import Conditions, Result
from cogmap.experiments.bodies.body_trial import BodyTrial
from cogmap.plots import plot_joint_reach

PAIRS = 100
"""Starts and goals under each condition."""
CLEAR = 0.05
"""How far (m) the links are from contact at least at starts and goals."""
MOST_STEPS = 200
"""Decisions after which a journey is ended."""
JOURNEY_SEED = 3000
"""Added to the seed."""
FRAMES = 6
"""Views of the film strip."""
DISTURBANCES: dict[str, dict[str, Any]] = {"slip_": {"slip": 0.05}, "weak_": {"motor_gains": (1.0, 0.7)}}
"""Motors that slip, and one that is weak."""
OBSTACLES = (
    Box(center=(1.25, 0.75), size=(0.3, 0.3), angle_deg=20, material="mosaic"),
    Box(center=(-1.2, 0.5), size=(0.25, 0.45), angle_deg=-10, material="marble"),
    Box(center=(0.15, -1.35), size=(0.4, 0.25), material="leather"),
)
"""Around a base in the middle of the room."""


class _Journeys(NamedTuple):
    gone: Journeys
    goals: Recording
    table: pd.DataFrame


def joint_reaching(trial: BodyTrial, conditions: Conditions, eye: AnyEye) -> Result:
    """Show an arm 100 images of fresh postures, and let its motors bring it there by what babbling taught.

    Within 1° or half of it is who ends with both joints so near. Ways are in joint space, over the shortest.
    `obstacles_`: among three boxes, where the arm babbled too; `ways_found` and `ways_touching` are the
    shares of these that begin and that something stops, `prm_` those of OMPL's roadmap of as many postures,
    which knows the room and checks its edges at 1°. `slip_`: motors slip by 5 %; `weak_`: one turns 70 % as
    far as told; each babbled anew. Nothing for another body than an arm of two links without limits.
    """
    body = trial.body
    if not isinstance(body, Arm) or [axis.kind for axis in body.axes] != ["circle", "circle"]:
        return Result({})
    eye, seed, room = conditions.camera or eye, conditions.seed, conditions.room
    among = room.model_copy(update={"boxes": (*room.boxes, *OBSTACLES)})
    found = {"": _reach(conditions, body, eye, (trial.walk, trial.fresh), trial.coordinates.encode)}
    others = {name: (room, body.model_copy(update=fields)) for name, fields in DISTURBANCES.items()}
    for name, (place, arm) in {**others, "obstacles_": (among, body)}.items():
        told = replace(conditions, room=place, body=arm)
        walk, fresh = (told.explore(Babble(), eye, body=arm, fresh=again) for again in (False, True))
        encode = ViewCode(seed=seed).fit(walk.views).transform
        found[name] = _reach(told, arm, eye, (walk, fresh), encode)
    metrics = {
        f"{name}{key}": value for name, part in found.items() for key, value in _summary(part.table).items()
    }
    hindered = found["obstacles_"]
    tried = hindered.table["outcome"] != Outcome.UNREACHABLE.name.lower()
    metrics |= {"ways_found": float(tried.mean()), "ways_touching": float(hindered.table["touched"].mean())}
    metrics |= _peer(among, body, hindered, len(trial.kept), seed)
    tables = [part.table.assign(condition=name.removesuffix("_") or "free") for name, part in found.items()]
    return Result(
        metrics,
        {"reaching": pd.concat(tables, ignore_index=True)},
        {"reach": _film(among, body, eye, hindered)},
        {"reach": "A reach among obstacles: what is seen on the way, the arm, and its way around the torus"},
    )


def _reach(
    conditions: Conditions,
    body: Arm,
    eye: AnyEye,
    walks: tuple[Recording, Recording],
    encode: Callable[[Any], Float[np.ndarray, "views features"]],
) -> _Journeys:
    """Let the arm reach fresh views from others."""
    walk, fresh = walks
    room, seed, joints = conditions.room, conditions.seed, fresh.require("joints")
    wide = body.model_copy(update={"width": body.width + 2 * CLEAR})
    clear = np.flatnonzero(wide.is_free(room, joints))
    starts, ends = np.random.default_rng(seed).permutation(clear)[: 2 * PAIRS].reshape(2, -1)
    goals = fresh[ends]
    reacher = PostureReacher(encode, walk.views, walk.require("commands"), walk.times, seed=seed)
    go = reacher.towards(np.asarray(goals.views))
    gone = journeys(room, go, eye, joints[starts], body=body, most_steps=MOST_STEPS, seed=seed + JOURNEY_SEED)
    return _Journeys(gone, goals, _scored(room, body, gone, goals.require("joints"), go.outcomes_))


def _scored(
    room: Arena, body: Arm, gone: Journeys, goals: Float[np.ndarray, "pairs 2"], outcomes: np.ndarray
) -> pd.DataFrame:
    """Measure journeys, a row each."""
    there = np.asarray(gone.joints)
    errors = np.rad2deg(np.abs(wrap_angle(there[-1] - goals)))
    shortest = shortest_joint_ways(room, body, np.stack([there[0], goals], axis=1))
    return pd.DataFrame(
        {
            **{f"start_{k}_deg": np.rad2deg(part) for k, part in enumerate(there[0].T, 1)},
            **{f"goal_{k}_deg": np.rad2deg(part) for k, part in enumerate(goals.T, 1)},
            **{f"error_{k}_deg": part for k, part in enumerate(errors.T, 1)},
            "way_rad": joint_length(there),
            "shortest_rad": shortest,
            "steps": gone.steps,
            "touched": gone.touched.any(axis=0),
            "outcome": [Outcome(outcome).name.lower() for outcome in outcomes],
        }
    )


def _summary(table: pd.DataFrame) -> dict[str, float]:
    """Sum up journeys."""
    off = table[["error_1_deg", "error_2_deg"]].max(axis=1)
    return {
        "reached_1deg": float((off <= 1).mean()),
        "reached_half_deg": float((off <= 0.5).mean()),
        "reached_median_deg": float(off.median()),
        "way_ratio_median": float((table["way_rad"] / table["shortest_rad"]).median()),
        "steps_median": float(table["steps"].median()),
    }


def _peer(room: Arena, body: Arm, ours: _Journeys, milestones: int, seed: int) -> dict[str, Any]:
    """Let OMPL's roadmap plan between the same postures."""
    pairs = np.stack([np.asarray(ours.gone.joints)[0], ours.goals.require("joints")], axis=1)
    paths = prm_joint_paths(room, pairs, arm=body, milestones=milestones, seed=seed)
    if paths is None:
        return {"prm": False}
    known = [(k, path) for k, path in enumerate(paths) if path is not None]
    ways = [path for _, path in known]
    ratios = [joint_length(path) / ours.table["shortest_rad"][k] for k, path in known]
    return {
        "prm": True,
        "prm_ways_found": len(known) / len(paths),
        "prm_ways_touching": float((~ways_are_free(room, body, ways)).mean()),
        "prm_way_ratio_median": float(np.median(ratios)),
    }


def _film(room: Arena, body: Arm, eye: AnyEye, ours: _Journeys) -> Figure:
    """Draw the journey that went the longest way round of those that arrived."""
    table, there = ours.table, np.asarray(ours.gone.joints)
    straight = np.linalg.norm(wrap_angle(there[0] - ours.goals.require("joints")), axis=1)
    arrived = table["outcome"] == Outcome.ARRIVED.name.lower()
    shown = int((table["shortest_rad"] / straight).where(arrived, 0.0).argmax())
    way = there[: ours.gone.steps[shown] + 1, shown]
    # evenly along the way, not in time
    gone = np.cumsum(np.linalg.norm(wrap_angle(np.diff(way, axis=0, prepend=way[:1])), axis=1))
    frames = np.searchsorted(gone, np.linspace(0, gone[-1], FRAMES) - 1e-9)
    views = np.empty((FRAMES, eye.height, eye.width, 3), np.uint8)
    see(eye, room, body, way[frames], out=views, rng=np.random.default_rng(0))
    goal = ours.goals.views[shown]
    return plot_joint_reach(room, body, way, frames=frames, views=views, goal=np.asarray(goal))
