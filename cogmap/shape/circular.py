"""Circular coordinates: the angles along the loops of a cloud."""

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from jaxtyping import Float, Int
from ripser import ripser
from scipy.sparse.linalg import cg, lsqr

from cogmap.errors import CogmapError
from cogmap.graph.neighbour_graph import checked_graph, components, edge_differences
from cogmap.graph.points import AnyCloud
from cogmap.graph.shortest_paths import Paths
from cogmap.inputs import Whole, checked_count
from cogmap.shape.rips import farthest_points, ratios
from cogmap.threads import one_thread

PRIME = 47
"""Cocycles are found modulo this; residues up to half of it are taken for positive numbers."""


class Loop(NamedTuple):
    """The loop of a cloud that stands out most, and where on it each point lies."""

    phase: Float[np.ndarray, "points"]
    """rad, in (−π, π]; NaN outside the largest connected piece."""
    birth: float
    death: float
    """When the loop closes and when it is filled, in lengths of the graph."""


class Loops(NamedTuple):
    """Several loops of a cloud, and where on each of them every point lies."""

    phases: Float[np.ndarray, "points loops"]
    """rad, up to whole turns; NaN outside the largest connected piece. The loop that stands out most comes
    first."""
    births: Float[np.ndarray, "loops"]
    deaths: Float[np.ndarray, "loops"]
    """When each closes and when it is filled, in lengths of the graph."""


def circular_coordinate(graph: AnyCloud, *, landmarks: Whole = 150, seed: Whole = 0) -> Loop:
    """Find the angle along the most persistent loop of a neighbour graph's largest piece.

    It is that of `circular_coordinates`, with phases replaced by their ranks, so that points lie evenly on
    the circle: an animal that looks in all directions equally often has its heading so, up to a turn and a
    mirror.

    Parameters
    ----------
    graph, landmarks, seed
        As for `circular_coordinates`.

    Raises
    ------
    CogmapError
        For something else than a neighbour graph, and when there is no loop.
    """
    phases, births, deaths = circular_coordinates(graph, 1, landmarks=landmarks, seed=seed)
    phase = phases[:, 0]
    points = np.flatnonzero(np.isfinite(phase))
    rank = np.argsort(np.argsort(np.mod(phase[points], 2 * np.pi), kind="stable"), kind="stable")
    phase[points] = 2 * np.pi * (rank + 0.5) / len(points) - np.pi
    return Loop(phase, float(births[0]), float(deaths[0]))


def circular_coordinates(graph: AnyCloud, loops: Whole, *, landmarks: Whole = 150, seed: Whole = 0) -> Loops:
    r"""Find the angles along the most persistent loops of a neighbour graph's largest piece.

    Landmarks far from each other in the graph have an integer cocycle for each of the longest bars of
    persistent cohomology, which gives every point a first phase. Of all circle-valued functions in its class
    the harmonic one changes least over the edges of the graph,

    .. math:: \min_f \sum_{ij} (f_j - f_i - 2 \pi n_{ij})^2,

    where n counts the edges that cross the cut. Which loops the phases wind around is told only up to an
    integer change of basis (`cogmap.shape.lattice`).

    Parameters
    ----------
    graph
        Symmetric lengths, as from `neighbour_graph`.
    loops
        How many angles; as many as `betti` counts loops.
    landmarks
        On which cohomology is computed.
    seed
        Chooses the first landmark.

    Raises
    ------
    CogmapError
        For something else than a neighbour graph, and when there are fewer loops.

    References
    ----------
    de Silva, Morozov & Vejdemo-Johansson (2011), Persistent cohomology and circular coordinates.
    """
    loops, landmarks = checked_count("loops", loops), checked_count("landmarks", landmarks)
    graph = checked_graph(graph)
    points = np.flatnonzero(components(graph).labels == 0)
    piece = sp.csr_array(graph[points][:, points])
    paths = Paths(piece)
    start = int(np.random.default_rng(seed).integers(len(points)))
    taken = farthest_points(paths, landmarks, start).indices
    lengths = paths.lengths(taken)
    distances = lengths[:, taken]
    bars, cocycles = _most_persistent(distances, loops)
    everywhere = np.full((graph.shape[0], loops), np.nan)
    with one_thread():
        for loop, (cocycle, scale) in enumerate(zip(cocycles, bars.mean(axis=1), strict=True)):
            at_landmarks = _smooth_cocycle(distances, float(scale), cocycle)
            everywhere[points, loop] = _harmonic(piece, _spread_out(lengths, at_landmarks))
    return Loops(everywhere, *bars.T)


def _most_persistent(
    distances: Float[np.ndarray, "landmarks landmarks"], loops: int
) -> tuple[Float[np.ndarray, "loops 2"], list[Int[np.ndarray, "edges 3"]]]:
    """Find the bars of H1 with the largest ratios and their cocycles: (landmark, landmark, residue)."""
    symmetric = np.maximum(distances, distances.T)
    found = ripser(symmetric, distance_matrix=True, maxdim=1, coeff=PRIME, do_cocycles=True)
    bars = found["dgms"][1].astype(np.float64)
    if len(bars) < loops:
        some = f"only {len(bars)} loops" if len(bars) else "no loop"
        raise CogmapError(f"the graph has {some} to take {loops} angles along; check with `betti`")
    longest = np.argsort(-ratios(bars), kind="stable")[:loops]
    return bars[longest], [found["cocycles"][1][loop] for loop in longest]


def _smooth_cocycle(
    distances: Float[np.ndarray, "landmarks landmarks"], scale: float, cocycle: Int[np.ndarray, "edges 3"]
) -> Float[np.ndarray, "landmarks"]:
    """Give landmarks the phases whose steps over the edges shorter than `scale` are least in its class."""
    integers = np.zeros(distances.shape)
    start, end, residue = cocycle.T
    integers[start, end] = np.where(residue > PRIME // 2, residue - PRIME, residue)
    integers -= integers.T
    starts, ends = np.nonzero(np.triu(distances <= scale, 1))
    difference = edge_differences(starts, ends, len(distances))
    return np.asarray(2 * np.pi * lsqr(difference, -integers[starts, ends], atol=1e-10, btol=1e-10)[0])


def _spread_out(
    paths: Float[np.ndarray, "landmarks points"], phases: Float[np.ndarray, "landmarks"]
) -> Float[np.ndarray, "points"]:
    """Give each point the mean direction of its nearest landmarks, weighted by closeness."""
    # A point has its first phase from its eight nearest landmarks.
    count = min(8, len(paths))
    near = np.argpartition(paths, count - 1, axis=0)[:count]
    length = np.take_along_axis(paths, near, 0)
    weight = 1 / (length + 1e-3 * length.max())
    return np.asarray(np.angle((weight * np.exp(1j * phases[near])).sum(axis=0)))


def _harmonic(graph: sp.csr_array, phase: Float[np.ndarray, "points"]) -> Float[np.ndarray, "points"]:
    """Smooth phases over the graph without changing how often they wind around a loop."""
    starts, ends = sp.triu(graph, 1).nonzero()
    step = phase[ends] - phase[starts]
    turns = np.round(step / (2 * np.pi))
    difference = edge_differences(starts, ends, len(phase))
    pull = difference.T @ (2 * np.pi * turns)
    return np.asarray(cg(difference.T @ difference, pull, x0=phase, rtol=1e-6)[0])
