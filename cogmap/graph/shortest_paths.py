"""Shortest paths in a graph, exact, from many points at once on every core."""

import typing

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int
from joblib import Parallel, cpu_count, delayed

from cogmap.kernels import kernel

WINDOW = 4
"""Mean lengths of an edge by which paths grow at a time; from 1 to 12 the time hardly changes."""
TASK = 8
"""Sources measured by a thread at a time, some milliseconds of work."""


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
        # Half the bytes of scipy's indices, as the graph is read from memory for every source.
        self._edges = (graph.indptr.astype(np.int32), graph.indices.astype(np.int32), graph.data)
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
        Parallel(cpu_count(), backend="threading")(
            delayed(_measure)(*self._edges, self._window, sources[task], targets, found[task])
            for task in (slice(first, first + TASK) for first in range(0, len(sources), TASK))
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
    ring, waiting = np.empty(nodes, np.int32), np.empty(nodes, np.int32)
    # 0: in neither, 1: in the ring, 2: in the list alone; one that moved to the ring stays listed until it grows.
    state = np.zeros(nodes, np.int8)
    first, size, listed, limit = 0, 1, 0, window
    nearest[source], ring[0], state[source] = 0.0, source, 1
    while size > 0:
        while size > 0:
            point = ring[first]
            first = 0 if first + 1 == nodes else first + 1
            size -= 1
            state[point], reached = 0, nearest[point]
            for edge in range(starts[point], starts[point + 1]):
                end, length = ends[edge], reached + lengths[edge]
                if length < nearest[end]:
                    nearest[end] = length
                    if length > limit:
                        # Was it below the limit before, it would not be above it now: nothing is listed twice.
                        if state[end] == 0:
                            state[end] = 2
                            waiting[listed] = end
                            listed += 1
                    elif state[end] != 1:
                        state[end] = 1
                        last = first + size
                        ring[last - nodes if last >= nodes else last] = end
                        size += 1
        # The nearest that waits is let in even if the window vanishes beside it by rounding.
        limit = np.inf
        for place in range(listed):
            if state[waiting[place]] == 2:
                limit = min(limit, nearest[waiting[place]])
        limit += window
        kept = 0
        for place in range(listed):
            point = waiting[place]
            if state[point] == 2:
                if nearest[point] <= limit:
                    state[point] = 1
                    ring[(first + size) % nodes] = point
                    size += 1
                else:
                    waiting[kept] = point
                    kept += 1
        listed = kept


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
