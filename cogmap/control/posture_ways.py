"""Ways between postures: a roadmap of remembered views whose edges are as long as motors must work."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int
from scipy.sparse.csgraph import dijkstra

from cogmap.control.visual_jacobian import Jacobians, VisualJacobian, implied_work
from cogmap.graph import nearest_points
from cogmap.graph.neighbour_graph import neighbour_graph

NEIGHBOURS, ONE_SIDED = 15, 5
"""Of the neighbour graph, see there."""
DANGER, CLEARANCE = 10.0, 2.0
"""How much dearer work is where something held the body, and how far around, spacings of memory."""
UNEXPLAINED = 0.8
"""Share of a change of codes beyond which, where no work explains it, it is no way but a look-alike."""
AHEAD = 30
"""Nearest remembered views among which the next one of a way is chosen."""


class Sight(NamedTuple):
    """Remembered views that are near to some views, the nearest first."""

    indices: Int[np.ndarray, "views near"]
    distances: Float[np.ndarray, "views near"]
    """Of codes."""
    work: Float[np.ndarray, "views near motors"]
    """Of the motors, command · s, that leads there."""
    effort: Float[np.ndarray, "views near"]
    """Its length; infinite where views are alike but no work leads from one to the other."""


class PostureWays:
    """Shortest ways over remembered views, in what motors must work, implied by the visual Jacobian.

    Parameters
    ----------
    codes
        Of the views that are remembered, spread evenly (`EvenMemory`).
    jacobian
        Learnt with the same code.
    """

    def __init__(self, codes: Float[np.ndarray, "kept features"], jacobian: VisualJacobian) -> None:
        self.codes, self.jacobian = codes, jacobian
        self._jacobians = jacobian.at(codes)

    @cached_property
    def graph(self) -> sp.csr_array:
        """Neighbours, and the work (command · s) from one to the other."""
        graph = sp.csr_array(sp.triu(neighbour_graph(self.codes, NEIGHBOURS, one_sided=ONE_SIDED), 1))
        starts, ends = graph.nonzero()
        change, (first, second) = self.codes[ends] - self.codes[starts], self._jacobians[[starts, ends]]
        _, effort = _work_between(first, second, change)
        known = np.flatnonzero(np.isfinite(effort))
        starts, ends = starts[known], ends[known]
        effort = effort[known] * (self.costs[starts] + self.costs[ends]) / 2
        graph = sp.csr_array((effort, (starts, ends)), shape=graph.shape)
        return sp.csr_array(graph + graph.T)

    @cached_property
    def costs(self) -> Float[np.ndarray, " kept"]:
        """Of work near each view: more than 1 where something held the body nearby."""
        held = self.jacobian.held_codes
        if not len(held):
            return np.ones(len(self.codes))
        distances = nearest_points(held, 1, queries=self.codes).distances[:, 0]
        return 1 + DANGER * np.exp(-np.square(distances / (CLEARANCE * self.spacing)))

    @cached_property
    def spacing(self) -> float:
        """Median distance of the codes of remembered views that are next to each other."""
        return float(np.median(nearest_points(self.codes, 1).distances))

    def look(self, codes: Float[np.ndarray, "views features"]) -> Sight:
        """Find what is remembered near views, and how to get there."""
        near, distances = nearest_points(self.codes, AHEAD, queries=codes)
        here = np.repeat(self.jacobian.at(codes), AHEAD, axis=0)
        change = (self.codes[near] - codes[:, None]).reshape(-1, codes.shape[1])
        work, effort = _work_between(here, self._jacobians[near.ravel()], change)
        return Sight(near, distances, work.reshape(*near.shape, -1), effort.reshape(near.shape))

    def work_left(self, sight: Sight) -> Float[np.ndarray, "goals kept"]:
        """Measure from each remembered view to the goals that these are near to; infinite without a way."""
        goals, kept = len(sight.indices), len(self.codes)
        known = np.isfinite(sight.effort) & (np.arange(AHEAD) < NEIGHBOURS)
        ends = sp.csr_array(
            (sight.effort[known], (known.nonzero()[0], sight.indices[known])), shape=(goals, kept)
        )
        # A goal is left, never passed.
        onwards = sp.hstack([self.graph, sp.csr_array((kept, goals))])
        joined = sp.csr_array(sp.vstack([onwards, sp.hstack([ends, sp.csr_array((goals, goals))])]))
        left: np.ndarray = dijkstra(joined, indices=np.arange(kept, kept + goals))[:, :kept]
        return left


def _work_between(
    here: Jacobians, there: Jacobians, change: Float[np.ndarray, "queries features"]
) -> tuple[Float[np.ndarray, "queries motors"], Float[np.ndarray, " queries"]]:
    """Give the work from view to view and its length, infinite where it does not explain how they differ."""
    ends = [(end, implied_work(end, change)) for end in (here, there)]
    rest = [np.linalg.norm(change - np.einsum("qmf,qm->qf", end, work), axis=1) for end, work in ends]
    # the mean of both ends: exact to second order
    mean = (ends[0][1] + ends[1][1]) / 2
    alike = np.maximum(*rest) > UNEXPLAINED * np.linalg.norm(change, axis=1)
    return mean, np.where(alike, np.inf, np.linalg.norm(mean, axis=1))
