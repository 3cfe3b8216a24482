"""Runs OMPL on what `prm` asks: `python -m cogmap.evaluation.peers.ompl_worker ASKED ANSWERED`."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import shapely
from ompl import base, geometric, util

from arena import Arena


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
    planner = geometric.PRM(setup.getSpaceInformation())
    setup.setPlanner(planner)
    setup.setup()
    moment = 0.05  # s by which the roadmap grows at a time, and that a query may take
    while planner.milestoneCount() < request["milestones"]:
        planner.growRoadmap(moment)
    paths: list[list[list[float]] | None] = []
    for pair in request["pairs"]:
        planner.clearQuery()
        ends = []
        for x, y, heading in pair:
            end = space.allocState()
            end.setX(x)
            end.setY(y)
            end.setYaw(heading)
            ends.append(end)
        setup.setStartAndGoalStates(*ends)
        setup.solve(moment)
        found = setup.getSolutionPath().getStates() if setup.haveExactSolutionPath() else None
        paths.append(None if found is None else [[s.getX(), s.getY(), s.getYaw()] for s in found])
    return paths


if __name__ == "__main__":
    order = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    Path(sys.argv[2]).write_text(json.dumps(answer(order)), encoding="utf-8")
