"""Visual roadmaps: ways among obstacles, planned from panoramas alone (Algorithm 1, Fig. 7)."""

from __future__ import annotations

import time
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import shapely
from jaxtyping import Float, Int
from matplotlib.figure import Figure

from arena import Arena, Brownian, Camera, Disc
from arena.angles import wrap_angle
from cogmap.errors import CogmapError
from cogmap.evaluation.deviation import path_deviation, path_length
from cogmap.evaluation.peers.prm import prm_paths
from cogmap.evaluation.shortest import shortest_lengths
from cogmap.experiments import Conditions, Result, experiment, pose_columns
from cogmap.navigation import PanoramaCode, VisualRoadmap
from cogmap.plots import plot_routes, plot_views

PAIRS, APART = 200, 1.0
"""Starts and goals, and how far (m) these are from each other at least."""
SHOWN = 6
"""Routes that are drawn."""


class _Plan(NamedTuple):
    route: Int[np.ndarray, "_"]
    """Views on the way."""
    path: Float[np.ndarray, "steps 3"] | None
    """Poses from start through those of the views to goal; None without a plan."""
    milliseconds: float


@experiment(room="obstacles", views=17_000)
def roadmap(conditions: Conditions) -> Result:
    """Algorithm 1 and Fig. 7: plan between 200 pairs of poses over views, and beside it with OMPL's PRM.

    The robot explores with a panoramic camera and a bumper 3 cm wider than its body, plans from the
    panoramas at start and goal, and is given no pose. Poses enter in the scores: the path leads from the
    start through the poses of the views to the goal, along straight lines. It touches an obstacle when the
    body's disc on it reaches more than 1 mm into a solid. The PRM has as many milestones as there are views,
    and the arena's own collision check; `prm_*` are left out when `ompl` is not installed, as `prm` tells.
    """
    room, body, around = conditions.room, Disc(), Camera.panoramic(120, 20)
    walk = conditions.explore(Brownian(), around, body=Disc(radius=body.radius + 0.03))
    poses = walk.require("poses")
    pairs = draw_pairs(room, body.radius, conditions.seed)
    started = time.perf_counter()
    code = PanoramaCode()
    planner = VisualRoadmap(code.fit_transform(walk.views))
    pieces = planner.pieces.sizes
    seconds = time.perf_counter() - started
    ends = code.transform(around.render(room, pairs.reshape(-1, 3))).reshape(PAIRS, 2, -1)
    plans = _plan(planner, ends, pairs, poses)
    shortest = shortest_lengths(room, pairs[:, :, :2], body.radius)
    ends_of = {**pose_columns(pairs[:, 0], "start_"), **pose_columns(pairs[:, 1], "goal_")}
    scores = _scores(room, [plan.path for plan in plans], shortest)
    table = pd.DataFrame({**ends_of, "shortest_m": shortest}).join(scores)
    table["query_ms"] = [plan.milliseconds for plan in plans]
    peer = prm_paths(room, pairs, radius=body.radius, milestones=conditions.views, seed=conditions.seed)
    metrics = _summary(table)
    if peer is not None:
        theirs = _scores(room, peer, shortest)
        table = table.join(theirs.add_prefix("prm_"))
        metrics |= {f"prm_{name}": value for name, value in _summary(theirs).items()}
        metrics["deviation_ratio"] = metrics["deviation_mean"] / metrics["prm_deviation_mean"]
    detour = shortest / np.linalg.norm(pairs[:, 1, :2] - pairs[:, 0, :2], axis=1)
    done = np.flatnonzero(table["success"])
    shown = done[np.argsort(-detour[done], kind="stable")][:SHOWN]
    return Result(
        metrics={
            "pairs": PAIRS,
            **metrics,
            "query_ms": float(table["query_ms"].median()),
            "prm": peer is not None,
            "pieces": len(pieces),
            "largest_piece": float(pieces[0] / pieces.sum()),
            "seconds": {"roadmap": round(seconds, 3)},
        },
        tables={"pairs": table, "routes": _routes_table([plan.route for plan in plans], poses)},
        figures=_figures(room, [(plans[pair], peer[pair] if peer else None) for pair in shown], poses),
        captions={
            "routes": "Routes planned over views, around obstacles, and beside them those of the peer",
            "images": "What is seen on the way along one route",
        },
    )


def draw_pairs(room: Arena, radius: float, seed: int) -> Float[np.ndarray, "pairs 2 3"]:
    """Draw starts and goals at least `APART` m from each other from the free space of a disc, m and rad.

    Raises
    ------
    CogmapError
        When free space is too small for that.
    """
    rng = np.random.default_rng(seed)
    places = room.sample_free(100 * PAIRS, radius, rng).reshape(-1, 2, 2)
    places = places[np.linalg.norm(places[:, 0] - places[:, 1], axis=1) >= APART][:PAIRS]
    if len(places) < PAIRS:
        raise CogmapError(f"room {room.name!r} has hardly any places {APART:g} m apart; take a larger room")
    return np.concatenate([places, rng.uniform(-np.pi, np.pi, (PAIRS, 2, 1))], axis=2)


def _plan(
    planner: VisualRoadmap,
    ends: Float[np.ndarray, "pairs 2 features"],
    pairs: Float[np.ndarray, "pairs 2 3"],
    poses: Float[np.ndarray, "views 3"],
) -> list[_Plan]:
    plans = []
    # What is made at the first plan is not part of a query.
    planner.nearest(ends[0, 0])
    for (start, goal), pair in zip(ends, pairs, strict=True):
        began = time.perf_counter()
        try:
            route = planner.plan(start, goal)
        except CogmapError:
            route = np.empty(0, dtype=int)
        lapse = 1e3 * (time.perf_counter() - began)
        path = np.vstack([pair[0], poses[route], pair[1]])
        plans.append(_Plan(route, path if len(route) and _arrives(path) else None, lapse))
    return plans


def _arrives(path: Float[np.ndarray, "steps 3"]) -> bool:
    """Tell whether the first and last view are within 0.3 m and 40° of start and goal."""
    off = path[[0, -1]] - path[[1, -2]]
    turn = np.abs(wrap_angle(off[:, 2]))
    return bool((np.linalg.norm(off[:, :2], axis=1) <= 0.3).all() and (turn <= np.deg2rad(40)).all())


def _scores(
    room: Arena,
    paths: list[Float[np.ndarray, "_ 3"] | None],
    shortest: np.ndarray,
) -> pd.DataFrame:
    """Tell of each path what it is worth; NaN where there is none."""
    solids = shapely.union_all([shapely.Polygon(solid.outline) for solid in room.solids])
    # A body that reaches no more than 1 mm into an obstacle does not touch it: paths are rounded.
    reach = Disc().radius - 1e-3
    rows = []
    for path, least in zip(paths, shortest, strict=True):
        row: dict[str, Any] = {"success": path is not None}
        if path is not None:
            length = path_length(path)
            row |= {
                "length_m": length,
                "length_ratio": length / least,
                "touches": bool(shapely.LineString(path[:, :2]).distance(solids) < reach),
                **{f"deviation_{name}": value for name, value in path_deviation(path)._asdict().items()},
            }
        rows.append(row)
    names = ["success", "length_m", "length_ratio", "touches"]
    names += ["deviation_mean", "deviation_variance", "deviation_maximum"]
    return pd.DataFrame(rows, columns=names).astype({"touches": "boolean"})


def _summary(scores: pd.DataFrame) -> dict[str, float]:
    done = scores["success"].astype(bool)
    return {
        "success": float(done.mean()),
        "length_ratio_median": float(scores["length_ratio"].median()),
        "paths_touching": float(scores["touches"][done].astype(float).mean()),
        "deviation_mean": float(scores["deviation_mean"].mean()),
        "deviation_variance": float(scores["deviation_variance"].mean()),
        "deviation_max": float(scores["deviation_maximum"].mean()),
    }


def _routes_table(routes: list[Int[np.ndarray, "_"]], poses: Float[np.ndarray, "views 3"]) -> pd.DataFrame:
    view = np.concatenate(routes)
    pair = np.repeat(np.arange(len(routes)), [len(route) for route in routes])
    return pd.DataFrame({"pair": pair, "view": view, **pose_columns(poses[view])})


def _figures(
    room: Arena,
    shown: list[tuple[_Plan, Float[np.ndarray, "_ 3"] | None]],
    poses: Float[np.ndarray, "views 3"],
) -> dict[str, Figure]:
    """Draw the routes that lead farthest around obstacles, and what is seen on the first."""
    paths = [(plan.path, theirs) for plan, theirs in shown if plan.path is not None]
    figures = {"routes": plot_routes(room, paths)}
    if shown:
        route = shown[0][0].route
        seen = route[np.linspace(0, len(route) - 1, min(9, len(route))).astype(int)]
        views = Camera.perspective(160, 120).render(room, poses[seen])
        figures["images"] = plot_views(views, poses[seen], panoramic=False)
    return figures
