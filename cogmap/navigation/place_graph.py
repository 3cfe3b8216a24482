"""Path planning over remembered places: the shortest way through where a body has been."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from jaxtyping import Bool, Float, Int
from scipy.ndimage import distance_transform_edt, label
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import KDTree

from cogmap.errors import CogmapError
from cogmap.inputs import check_array

CELLS = 2.5
"""Cells within the distance at which views lie densely."""
SHY = 3.0
"""How many times longer a way counts where it has no margin at all."""


@dataclass(eq=False)
class PlaceGraph:
    r"""Plans ways over the positions of remembered views, in the unit of these.

    A square cell is free when a view lies within `reach` of its middle: where a body has been a body can be,
    and what it went around is a hole. Dijkstra's algorithm runs over the free cells, in which a step of
    length ℓ at a distance c from what is not free costs ℓ (1 + 3 max(0, 1 − c / margin)): a way keeps off
    walls where there is room. Then corners are pulled straight while the line between them keeps as far from
    what is not free as the margin, or as the way itself did.

    Parameters
    ----------
    position
        Of the remembered views.
    reach
        Distance between views that lie densely; when None 1.5 times that within which 95 % of them have
        eight others.
    margin
        Distance from what is not free that a way keeps where it can; `reach` when None.

    Raises
    ------
    CogmapError
        For positions that are not finite, and by `plan` when there is no way.

    References
    ----------
    Thorpe (1984), Path relaxation; Daniel, Nash, Koenig & Felner (2010), Theta*: any-angle path planning.
    """

    position: Float[np.ndarray, "views 2"]
    _: KW_ONLY
    reach: float | None = None
    margin: float | None = None

    def plan(
        self, start: Float[np.ndarray, "2"], goal: Float[np.ndarray, "2"]
    ) -> Float[np.ndarray, "corners 2"]:
        """Give the corners of the way from start to goal, these included.

        Raises
        ------
        CogmapError
            When start and goal lie in separate parts of what was visited.
        """
        ends = np.stack([start, goal])
        cells = self._nearest_cells(ends)
        if self._pieces[cells[0]] != self._pieces[cells[1]]:
            raise CogmapError(
                "no way leads from start to goal: they lie in separate parts of what was visited; "
                "explore between them"
            )
        before = dijkstra(self._graph, directed=False, indices=[cells[1]], return_predecessors=True)[1][0]
        way = [int(cells[0])]
        while way[-1] != cells[1]:
            way.append(int(before[way[-1]]))
        middles = self._middles[way]
        return self._pulled_straight(np.concatenate([ends[:1], middles[1:-1], ends[1:]]))

    def is_free(self, start: Float[np.ndarray, "2"], goal: Float[np.ndarray, "2"]) -> bool:
        """Whether the straight way keeps within what was visited."""
        return bool(self._clearance_along(start, goal) > 0)

    def sees(self, start: Float[np.ndarray, "2"], goal: Float[np.ndarray, "2"]) -> bool:
        """Whether the straight way keeps the margin, or as far from what is not free as its ends."""
        held = min(self._margin, *(self._clearance_along(end, end) for end in (start, goal)))
        return self.is_free(start, goal) and self._clearance_along(start, goal) >= held - self._cell

    @cached_property
    def spacing(self) -> float:
        """Distance at which views lie densely."""
        if self.reach is not None:
            return self.reach
        count = min(8, len(self.position) - 1)
        if count < 1:
            raise CogmapError("one remembered view makes no way; remember more")
        distances = KDTree(self.position).query(self.position, k=[count + 1])[0]
        return float(1.5 * np.percentile(distances, 95))

    @cached_property
    def edges(self) -> Float[np.ndarray, "edges 4"]:
        """Ends x, y, x, y of all steps between free cells that ways are made of."""
        pairs = self._graph.tocoo()
        return np.hstack([self._middles[pairs.row], self._middles[pairs.col]])

    @cached_property
    def _cell(self) -> float:
        check_array("position", self.position, (None, 2))
        return self.spacing / CELLS

    @cached_property
    def _corner(self) -> Float[np.ndarray, "2"]:
        return np.asarray(self.position.min(axis=0) - 3 * self.spacing)

    @cached_property
    def _clearance(self) -> Float[np.ndarray, "x y"]:
        """Distance of each cell from what is not free, 0 where it is not."""
        shape = np.ceil((self.position.max(axis=0) + 3 * self.spacing - self._corner) / self._cell)
        axes = [np.arange(int(count)) + 0.5 for count in shape]
        middles = self._corner + self._cell * np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
        distances = KDTree(self.position).query(middles, distance_upper_bound=self.spacing)[0]
        # closing: what the discs around the views cover, less a rim as wide as they are
        covered = distance_transform_edt(np.isfinite(distances)) * self._cell
        return np.maximum(covered - self.spacing, 0)

    @cached_property
    def _free(self) -> Bool[np.ndarray, "x y"]:
        return self._clearance > 0

    @cached_property
    def _names(self) -> Int[np.ndarray, "x y"]:
        """Number of each free cell, −1 of others."""
        names = np.full(self._free.shape, -1)
        names[self._free] = np.arange(self._free.sum())
        return names

    @cached_property
    def _middles(self) -> Float[np.ndarray, "cells 2"]:
        return np.asarray(self._corner + self._cell * (np.argwhere(self._free) + 0.5))

    @cached_property
    def _pieces(self) -> Int[np.ndarray, "cells"]:
        return np.asarray(label(self._free, structure=np.ones((3, 3)))[0][self._free])

    @property
    def _margin(self) -> float:
        return self.spacing if self.margin is None else self.margin

    @cached_property
    def _graph(self) -> sp.csr_array:
        cost = 1 + SHY * np.maximum(0, 1 - self._clearance / self._margin)
        rows, columns, lengths = [], [], []
        width, height = self._free.shape
        # half of the sixteen directions: the others are the same steps backwards
        for dx, dy in ((1, 0), (0, 1), (1, 1), (1, -1), (2, 1), (1, 2), (2, -1), (1, -2)):
            here = (slice(0, width - dx), slice(max(0, -dy), height - max(0, dy)))
            there = (slice(dx, width), slice(max(0, dy), height + min(0, dy)))
            fits = self._free[here] & self._free[there]
            rows.append(self._names[here][fits])
            columns.append(self._names[there][fits])
            length = self._cell * np.hypot(dx, dy)
            lengths.append(length * (cost[here][fits] + cost[there][fits]) / 2)
        pairs = (np.concatenate(rows), np.concatenate(columns))
        count = len(self._middles)
        return sp.csr_array((np.concatenate(lengths), pairs), shape=(count, count))

    def _nearest_cells(self, points: Float[np.ndarray, "points 2"]) -> Int[np.ndarray, "points"]:
        return np.asarray(KDTree(self._middles).query(points)[1])

    def _clearance_along(self, start: Float[np.ndarray, "2"], goal: Float[np.ndarray, "2"]) -> float:
        """Give the least distance from what is not free along a line; 0 where it leaves what is."""
        count = int(np.ceil(2 * np.linalg.norm(goal - start) / self._cell)) + 1
        points = start + np.linspace(0, 1, count)[:, None] * (goal - start)
        cells = np.floor((points - self._corner) / self._cell).astype(int)
        inside = ((cells >= 0) & (cells < self._free.shape)).all(axis=1)
        return float(self._clearance[tuple(cells.T)].min()) if inside.all() else 0.0

    def _pulled_straight(self, way: Float[np.ndarray, "points 2"]) -> Float[np.ndarray, "corners 2"]:
        """Leave out corners while the way keeps its distance."""
        legs = np.array([self._clearance_along(a, b) for a, b in pairwise(way)])
        kept = [0]
        while kept[-1] < len(way) - 1:
            here = kept[-1]
            for there in range(len(way) - 1, here, -1):
                held = min(self._margin, legs[here:there].min())
                if there == here + 1 or self._clearance_along(way[here], way[there]) >= held:
                    kept.append(there)
                    break
        return way[kept]
