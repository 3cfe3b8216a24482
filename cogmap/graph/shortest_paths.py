"""Shortest paths in a graph, exact, from many points at once on every core."""

import typing

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int
from joblib import Parallel, cpu_count, delayed

from cogmap.kernels import kernel

WINDOW = 4
"""Mean lengths of an edge by which paths grow at a time; from 1 to 12 the time hardly changes."""
IDLE, QUEUED, WAITS = 0, 1, 2
"""Where a point is while paths grow: nowhere, in the ring of those to visit, in the list of those too far."""
TASK = 2_000_000
"""Edges that a thread passes at a time, some milliseconds of work; less is done without threads."""


class Paths:
    """The shortest paths in a graph.

    The length of a path is the sum of its edges from its start on, in float64; rounding never makes a longer
    path the shorter one, so that the least length is the same to the bit in whatever order points are
    reached, and that of any other algorithm.

    Parameters
    ----------
    graph
        Lengths > 0, as from `neighbour_graph`; those of a row lead away from its point.
    """

    def __init__(self, graph: sp.csr_array) -> None:
        # Half the bytes of scipy's indices; unsigned, as numba looks at every sign to count from the end.
        self._edges = (
            graph.indptr.astype(np.uint32),
            graph.indices.astype(np.uint32),
            graph.data.astype(np.float64),
        )
        self._window = WINDOW * float(graph.data.mean()) if graph.nnz else 0.0

    def __len__(self) -> int:
        return len(self._edges[0]) - 1

    def nearer(self, point: int, nearest: Float[np.ndarray, "points"]) -> Float[np.ndarray, "points"]:
        """Take the smaller of `nearest` and the distances from a point; what is no nearer costs no time.

        `nearest` must be distances from points, any number of them, in this graph.
        """
        nearest = nearest.copy()
        _shorten(*self._edges, self._window, point, nearest)
        return nearest

    def among(self, points: Int[np.ndarray, "points"]) -> Float[np.ndarray, "points points"]:
        """Measure from each of some points (rows) to each (columns)."""
        return self.lengths(points, points)

    def lengths(
        self, sources: Int[np.ndarray, "sources"], targets: Int[np.ndarray, "targets"] | None = None
    ) -> Float[np.ndarray, "sources targets"]:
        """Measure from each source to each target, by default all points; infinite where no path leads."""
        sources = np.asarray(sources, np.int64)
        targets = np.arange(len(self)) if targets is None else np.asarray(targets, np.int64)
        found = np.empty((len(sources), len(targets)))
        size = max(8, TASK // max(1, len(self._edges[1])))
        tasks = [slice(first, first + size) for first in range(0, len(sources), size)]
        Parallel(cpu_count() if len(tasks) > 1 else 1, backend="threading")(
            delayed(_measure)(*self._edges, self._window, sources[task], targets, found[task])
            for task in tasks
        )
        return found


@kernel(nogil=True)
@typing.no_type_check
def _shorten(
    starts: np.ndarray,
    ends: np.ndarray,
    lengths: np.ndarray,
    window: float,
    source: int,
    nearest: np.ndarray,
) -> None:
    """Lower `nearest` to the lengths of the paths from `source` wherever these are less.

    Labels are corrected until nothing changes (Bellman & Ford), first in, first out, within windows of length
    that follow each other (delta-stepping: Meyer & Sanders 2003). On neighbour graphs a point is visited 1.02
    times, and there is no heap to keep.
    """
    nodes = len(nearest)
    # Points to visit: a ring of those nearer than `limit`, and a list of those that wait for its growth.
    ring, waiting = np.empty(nodes, np.uint32), np.empty(nodes, np.uint32)
    # What moves from the list to the ring before the limit grows stays listed until then.
    state = np.full(nodes, IDLE, np.int8)
    first, size, listed, limit = 0, 1, 0, window
    nearest[source], ring[0], state[source] = 0.0, source, QUEUED
    while size > 0:
        while size > 0:
            point = ring[first]
            first = 0 if first + 1 == nodes else first + 1
            size -= 1
            state[point], reached = IDLE, nearest[point]
            for edge in range(starts[point], starts[point + 1]):
                end, length = ends[edge], reached + lengths[edge]
                if length < nearest[end]:
                    nearest[end] = length
                    # Whoever left the ring was below the limit and gets no farther: nobody is listed twice.
                    if length > limit:
                        if state[end] == IDLE:
                            state[end] = WAITS
                            waiting[listed] = end
                            listed += 1
                    elif state[end] != QUEUED:
                        state[end] = QUEUED
                        last = first + size
                        ring[last - nodes if last >= nodes else last] = end
                        size += 1
        limit = _next_limit(nearest, waiting[:listed], state, window)
        kept = 0
        for place in range(listed):
            point = waiting[place]
            if state[point] == WAITS and nearest[point] <= limit:
                state[point] = QUEUED
                ring[(first + size) % nodes] = point
                size += 1
            elif state[point] == WAITS:
                waiting[kept] = point
                kept += 1
        listed = kept


@kernel(nogil=True)
@typing.no_type_check
def _next_limit(nearest: np.ndarray, waiting: np.ndarray, state: np.ndarray, window: float) -> float:
    """Let in the nearest that waits, even if the window vanishes beside it by rounding, and a window more."""
    least = np.inf
    for point in waiting:
        if state[point] == WAITS:
            least = min(least, nearest[point])
    return least + window


@kernel(nogil=True)
@typing.no_type_check
def _measure(
    starts: np.ndarray,
    ends: np.ndarray,
    lengths: np.ndarray,
    window: float,
    sources: np.ndarray,
    targets: np.ndarray,
    found: np.ndarray,
) -> None:
    """Fill in, row by row, how far it is from each source to each target."""
    nearest = np.empty(len(starts) - 1)
    for row in range(len(sources)):
        nearest[:] = np.inf
        _shorten(starts, ends, lengths, window, sources[row], nearest)
        for column in range(len(targets)):
            found[row, column] = nearest[targets[column]]
