"""Visual dynamics: what pushes do to a body with mass, learnt by sight, and stops at the pose of an image."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import shapely
from jaxtyping import Float, UInt8

from arena import Arena, Babble, Brownian, Camera, HeavyDisc, Recording, explore
from arena.acting import Journeys, journeys
from arena.motions.locomotion import free_space
from arena.motions.policy import Policy, Sensed
from cogmap.control import MotorModel, Reaching
from cogmap.control.motor_model import body_motion, carried
from cogmap.control.percept import MapPercept, Percept
from cogmap.control.steering import Steering
from cogmap.errors import CogmapError
from cogmap.evaluation.image_quality import psnr
from cogmap.evaluation.peers.true_pose import PoseEye, TruePercept
from cogmap.evaluation.populations import grow_map, trust_report
from cogmap.experiments import Conditions, Result, experiment
from cogmap.experiments.acting.travels import BABBLING_SEED, CLEAR, JOURNEY_SEED, draw_poses, scored
from cogmap.imagination import Imagination
from cogmap.navigation.place_graph import PlaceGraph
from cogmap.plots import plot_foretold, plot_stops

BODIES, JOURNEYS = 5, 20
"""Bodies of unknown mass and gain, and journeys of each."""
DT, BABBLED, AHEAD = 0.2, 10.0, 1.0
"""Time from decision to decision, of babbling in all, and that is foretold, s."""
LONGEST = 60.0
"""Time after which a journey is ended, s."""
FULL_SPEED = 3
"""Time constants of the run-up: it begins to stop at 95 % of its speed."""
STOPPED, SLOW = 0.03, 0.02
"""How near (m) the goal it must be, and slower than what (m/s)."""


class _RunUp:
    """Goes straight on at full speed for some decisions, before a policy is asked."""

    def __init__(self, policy: Policy, decisions: int) -> None:
        self._policy, self._left = policy, decisions

    def __call__(self, sensed: Sensed) -> Any:
        self._left -= 1
        return np.tile([1.0, 0.0], (len(sensed["view"]), 1)) if self._left >= 0 else self._policy(sensed)


class _Stops(NamedTuple):
    """Journeys of one body."""

    body: HeavyDisc
    gone: Journeys
    goals: Float[np.ndarray, "journeys 3"]
    run_up: int
    table: pd.DataFrame


class _Foretold(NamedTuple):
    """Views some time ahead, as foretold and as seen."""

    now: UInt8[np.ndarray, "moments height width 3"]
    then: UInt8[np.ndarray, "moments height width 3"]
    views: dict[str, UInt8[np.ndarray, "moments height width 3"]]
    """By who foretells."""


@experiment(room="furnished", views=17_000, takes=("map",))
def dynamics(conditions: Conditions) -> Result:
    """Stop a body of unknown mass and gain at the pose of an image, from full speed; foretell what it sees.

    A map is learnt and its places are relaxed from one walk of a body without mass. Then each of five bodies
    whose mass, inertia and gains are drawn babbles 10 s, from which it learns a motor model of second order;
    twenty journeys of it begin at full speed and end where it says that it has arrived. Those that stand
    still within 3 cm count as stopped. `first_order_`: the same with a model without persistence; `true_`:
    with an eye that sees the pose itself, so that what is learnt is the physics. What is seen 1 s ahead is
    imagined at the pose that two percepts, their commands and those to come foretell, on the way of the
    journeys; `true_ahead_`: at the pose that the map perceives then. Poses draw starts and goals and score
    the ends.
    """
    room, camera = conditions.room, Camera.panoramic()
    walk = conditions.explore(Brownian(), camera)
    cmap = grow_map(walk, conditions.map, seed=conditions.seed, progress=conditions.progress)
    cmap.refine(walk.views)
    if cmap.relaxed_places_ is None:
        raise CogmapError(f"nothing reaches anything with this map: {cmap.refine_reason_}; explore more")
    sight = MapPercept(cmap)
    dream = Imagination(cmap, memory=walk.views)
    truth, places = TruePercept(), walk.require("poses")[:, :2]
    ways = {"": PlaceGraph(cmap.relaxed_places_.places_), "true_": PlaceGraph(places)}
    rng = np.random.default_rng(conditions.seed)
    stops: dict[str, list[_Stops]] = {"": [], "first_order_": [], "true_": []}
    foretold = []
    for number in range(BODIES):
        body = draw_body(rng)
        seed = conditions.seed + BODIES * number
        starts = _starts(room, body, rng)
        goals = draw_poses(room, body.radius, len(starts), rng)
        spell = _babble(room, camera, body, seed)
        second, first = (_learnt(spell, sight, order) for order in (2, 1))
        # let it try, though it knows how badly it fits
        first.noise_ = np.zeros(3)
        models: dict[str, tuple[MotorModel, Percept, Any]] = {
            "": (second, sight, camera),
            "first_order_": (first, sight, camera),
            "true_": (_learnt(_babble(room, PoseEye(), body, seed), truth, 2), truth, PoseEye()),
        }
        for name, (motor, percept, eye) in models.items():
            images = eye.render(room, goals, rng=rng)
            go = Reaching(percept, ways.get(name, ways[""]), Steering(motor), images)
            stops[name].append(_stop(room, go, eye, starts, goals, body=body, seed=seed))
        foretold.append(_foretell(room, camera, dream, {"": second, "first_order_": first}, stops[""][-1]))
    tables = {
        name: pd.concat([each.table.assign(body=k) for k, each in enumerate(found)], ignore_index=True)
        for name, found in stops.items()
    }
    seen = _Foretold(
        np.concatenate([each.now for each in foretold]),
        np.concatenate([each.then for each in foretold]),
        {name: np.concatenate([each.views[name] for each in foretold]) for name in foretold[0].views},
    )
    fits = {name: psnr(views, seen.then) for name, views in seen.views.items()}
    metrics: dict[str, Any] = {"journeys": len(tables[""]), "babbling_s": BABBLED}
    for name, table in tables.items():
        off = table["position_error_m"]
        metrics |= {
            f"{name or 'stopped_'}within_3cm": float((table["stopped"] & (off <= STOPPED)).mean()),
            f"{name or 'stopped_'}median_m": float(off.median()),
            f"{name or 'stopped_'}heading_median_deg": float(table["heading_error_deg"].median()),
            f"{name or 'stopped_'}seconds_median": float(table["seconds"].median()),
        }
    metrics |= {
        "ahead_1s_psnr_db": float(np.median(fits[""])),
        "ahead_1s_psnr_p05_db": float(np.percentile(fits[""], 5)),
        "first_order_ahead_psnr_db": float(np.median(fits["first_order_"])),
        "true_ahead_psnr_db": float(np.median(fits["true_"])),
        "persistence_psnr_db": float(np.median(psnr(seen.now, seen.then))),
        **trust_report(cmap),
    }
    names = {"": "second order", "first_order_": "first order", "true_": "true pose"}
    shown = np.unique(np.linspace(0, len(seen.now) - 1, 4).astype(int))
    return Result(
        metrics=metrics,
        tables={
            "stops": pd.concat(
                [table.assign(model=names[name]) for name, table in tables.items()], ignore_index=True
            ),
            "foretold": pd.DataFrame({f"{name}psnr_db": fit for name, fit in fits.items()}),
        },
        figures={
            "stops": plot_stops(
                room,
                [(each.gone, each.goals, each.run_up, each.body) for each in stops[""]],
                {names[name]: table for name, table in tables.items()},
            ),
            "foretold": plot_foretold(
                seen.now[shown], seen.views[""][shown], seen.views["first_order_"][shown], seen.then[shown]
            ),
        },
        captions={
            "stops": "Stops at the pose of an image, from full speed: ways, speeds, distances from the goal",
            "foretold": f"What is seen now, what is foretold for {AHEAD:g} s later, and what is seen then",
        },
    )


def draw_body(rng: np.random.Generator) -> HeavyDisc:
    """Draw mass, inertia and gains: time constants of 0.3 to 1 s and of 0.1 to 0.4 s."""
    return HeavyDisc(
        mass=rng.uniform(3, 10),
        inertia=rng.uniform(0.05, 0.2),
        max_speed=rng.uniform(0.4, 0.8),
        max_turn=rng.uniform(1.5, 4),
    )


def _babble(room: Arena, eye: Any, body: HeavyDisc, seed: int) -> Recording:
    """Push at random for a while, beginning where there is most room."""
    widest = np.asarray(shapely.maximum_inscribed_circle([free_space(room, body)]))[0]
    x, y = widest.coords[0]
    views = round(BABBLED / DT) + 1
    return explore(
        room, Babble(dt=DT, start=(x, y, 0.0)), eye, body=body, views=views, seed=seed + BABBLING_SEED
    )


def _learnt(spell: Recording, percept: Percept, order: Any) -> MotorModel:
    seen = percept.perceive(np.asarray(spell.views))
    return MotorModel(order).partial_fit(spell.require("commands")[:-1], seen[:-1], seen[1:])


def _run_up(body: HeavyDisc) -> int:
    return int(np.ceil(FULL_SPEED * body.lags[0] / DT))


def _starts(room: Arena, body: HeavyDisc, rng: np.random.Generator) -> Float[np.ndarray, "journeys 3"]:
    """Draw poses from where it can run up straight, and coast."""
    way = np.linspace(0, (_run_up(body) * DT + body.lags[0]) * body.max_speed, 40)
    found = np.empty((0, 3))
    while len(found) < JOURNEYS:
        poses = draw_poses(room, body.radius, 10 * JOURNEYS, rng)
        ahead = np.stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])], axis=1)
        points = poses[:, None, :2] + way[:, None] * ahead[:, None]
        free = room.is_free(points.reshape(-1, 2), body.radius + CLEAR).reshape(len(poses), -1)
        found = np.concatenate([found, poses[free.all(axis=1)]])
    return found[:JOURNEYS]


def _stop(
    room: Arena,
    policy: Reaching,
    eye: Any,
    starts: Float[np.ndarray, "journeys 3"],
    goals: Float[np.ndarray, "journeys 3"],
    *,
    body: HeavyDisc,
    seed: int,
) -> _Stops:
    run_up = _run_up(body)
    most = run_up + round(LONGEST / DT)
    gone = journeys(
        room, _RunUp(policy, run_up), eye, starts, body=body, dt=DT, most_steps=most, seed=seed + JOURNEY_SEED
    )
    table = scored(room, gone, goals, body)
    table["seconds"] -= run_up * DT
    # at rest, when it says that it has arrived: slower than 2 cm/s
    last = np.stack([gone.poses[step - 1 : step + 1, k, :2] for k, step in enumerate(gone.steps)])
    slow = np.linalg.norm(last[:, 1] - last[:, 0], axis=1) < SLOW * DT
    table["stopped"] = slow & (gone.steps < most)
    return _Stops(body, gone, goals, run_up, table)


def _foretell(
    room: Arena, camera: Camera, dream: Imagination, motors: dict[str, MotorModel], stops: _Stops
) -> _Foretold:
    """Imagine what is seen some time after a moment of each journey, whose commands are known."""
    steps, gone = round(AHEAD / DT), stops.gone
    whose = np.flatnonzero(gone.steps > stops.run_up + steps)
    # soon after the run-up, or later and later, as far as the journeys last
    share = np.linspace(0, 1, len(whose)) * (gone.steps[whose] - steps - stops.run_up)
    when = stops.run_up + share.astype(int)
    before, now, then = (camera.render(room, gone.poses[when + k, whose]) for k in (-1, 0, steps))
    commands = np.stack([gone.commands[when + k, whose] for k in range(-1, steps)])
    (x0, heading0), (x, heading), truth = (dream.perceive(views) for views in (before, now, then))
    views = {"true_": dream.at(*truth).views}
    for name, motor in motors.items():
        position, phase = x, heading
        for motion in motor.roll_out(commands[1:], commands[0], body_motion(x0, heading0, x, heading)):
            position, phase = carried(position, phase, motion)
        views[name] = dream.at(position, phase).views
    return _Foretold(now, then, views)
