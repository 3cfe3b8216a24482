"""Runs OMPL on what `prm` asks: `python -m cogmap.evaluation.peers.ompl_worker ASKED ANSWERED`."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable
from itertools import islice, pairwise, product
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from ompl import base, geometric, util

from arena import Arena, Arm

MOMENT = 0.05
"""By which the roadmap grows at a time, and that a query may take, s."""
CELLS = 720
"""A turn, of the table of postures that are free."""
EDGE = math.radians(1)
"""Steps in which edges of joints are checked."""


def answer(request: dict[str, Any]) -> list[list[list[float]] | None]:
    """Grow one roadmap in SE(2), then plan between the pairs on it."""
    arena = Arena.parse(request["arena"])
    free = arena.free_space(request["radius"])
    shapely.prepare(free)
    util.RNG.setSeed(request["seed"] + 1)
    space, bounds = base.SE2StateSpace(), base.RealVectorBounds(2)
    x0, y0, x1, y1 = free.bounds
    for axis, (low, high) in enumerate(((x0, x1), (y0, y1))):
        bounds.setLow(axis, low)
        bounds.setHigh(axis, high)
    space.setBounds(bounds)
    setup = geometric.SimpleSetup(space)
    setup.setStateValidityChecker(lambda state: bool(shapely.contains_xy(free, state.getX(), state.getY())))
    # A share of the largest extent; its default of 1 % lets edges cut corners by centimetres.
    setup.getSpaceInformation().setStateValidityCheckingResolution(0.02 / space.getMaximumExtent())
    return _plan(setup, request, _pose, lambda s: [s.getX(), s.getY(), s.getYaw()])


def answer_joints(request: dict[str, Any]) -> list[list[list[float]] | None]:
    """Grow one roadmap over the joints of an arm, then plan between the pairs on it.

    States of OMPL's circles cannot be read from Python, so that joints go on lines of two turns, where a goal
    stands wherever it is less than a turn from the start, and the shortest way counts.
    """
    arena, arm = Arena.parse(request["arena"]), Arm(**request["arm"])
    util.RNG.setSeed(request["seed"] + 1)
    joints = range(len(arm.axes))
    space, bounds = base.RealVectorStateSpace(len(joints)), base.RealVectorBounds(len(joints))
    bounds.setLow(-math.tau)
    bounds.setHigh(math.tau)
    space.setBounds(bounds)
    setup = geometric.SimpleSetup(space)
    # asked one by one of the room, ten thousand times as long as of a table
    cells = np.linspace(-np.pi, np.pi, CELLS, endpoint=False) + np.pi / CELLS
    grid = np.stack(np.meshgrid(*[cells] * len(joints), indexing="ij"), axis=-1)
    free = arm.is_free(arena, grid.reshape(-1, len(joints))).reshape(grid.shape[:-1])

    def is_free(state: Any) -> bool:
        return bool(free[tuple(int((state[k] + math.pi) / math.tau * CELLS) % CELLS for k in joints)])

    def put(state: Any, values: list[float]) -> None:
        for k in joints:
            state[k] = values[k]

    setup.setStateValidityChecker(is_free)
    setup.getSpaceInformation().setStateValidityCheckingResolution(EDGE / space.getMaximumExtent())
    turns, images = list(product((-math.tau, 0.0, math.tau), repeat=len(joints))), []
    for start, goal in request["pairs"]:
        moved = [[angle + turn for angle, turn in zip(goal, turn_by, strict=True)] for turn_by in turns]
        images.append(
            [
                (start, there)
                for there in moved
                if all(
                    abs(angle) < math.tau and abs(angle - begun) < math.tau
                    for angle, begun in zip(there, start, strict=True)
                )
            ]
        )
    request = request | {
        "pairs": [pair for pairs in images for pair in pairs],
        "milestones": 2 ** len(joints) * request["milestones"],
    }
    paths = iter(_plan(setup, request, put, lambda state: [state[k] for k in joints]))
    found = [[path for path in islice(paths, len(pairs)) if path is not None] for pairs in images]
    return [min(some, key=_length, default=None) for some in found]


def _length(path: list[list[float]]) -> float:
    return sum(math.dist(a, b) for a, b in pairwise(path))


def _pose(state: Any, values: list[float]) -> None:
    x, y, heading = values
    state.setX(x)
    state.setY(y)
    state.setYaw(heading)


def _plan(
    setup: Any,
    request: dict[str, Any],
    put: Callable[[Any, list[float]], None],
    told: Callable[[Any], list[float]],
) -> list[list[list[float]] | None]:
    planner = geometric.PRM(setup.getSpaceInformation())
    setup.setPlanner(planner)
    setup.setup()
    while planner.milestoneCount() < request["milestones"]:
        planner.growRoadmap(MOMENT)
    paths: list[list[list[float]] | None] = []
    for pair in request["pairs"]:
        planner.clearQuery()
        ends = []
        for values in pair:
            end = setup.getStateSpace().allocState()
            put(end, values)
            ends.append(end)
        setup.setStartAndGoalStates(*ends)
        setup.solve(MOMENT)
        found = setup.getSolutionPath().getStates() if setup.haveExactSolutionPath() else None
        paths.append(None if found is None else [told(state) for state in found])
    return paths


if __name__ == "__main__":
    order = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    answered = answer_joints(order) if "arm" in order else answer(order)
    Path(sys.argv[2]).write_text(json.dumps(answered), encoding="utf-8")
