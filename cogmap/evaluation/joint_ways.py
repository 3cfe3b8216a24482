"""Ways of joints: how long the shortest is that touches nothing, for comparison; here the room is known."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from jaxtyping import Bool, Float
from scipy.sparse.csgraph import dijkstra

from arena import Arena, Body
from arena.angles import wrap_angle
from cogmap.errors import CogmapError
from cogmap.inputs import check_array

CELLS = 180
"""Of the grid a turn, 2° each."""
FINE = np.deg2rad(0.25)
"""Steps in which a way is looked through for contact."""
MOVES = ((0, 1), (1, 0), (1, 1), (1, -1), (1, 2), (2, 1), (1, -2), (2, -1))
"""Between cells, and back: ways on the grid are 1.4 % too long on average, if they are not straight."""


def ways_are_free(
    arena: Arena, body: Body, ways: list[Float[np.ndarray, "_ joints"]]
) -> Bool[np.ndarray, " ways"]:
    """Tell which ways touch nothing, straight from posture to posture (rad), the short way round."""
    free = np.empty(len(ways), bool)
    for k, way in enumerate(ways):
        steps = wrap_angle(np.diff(way, axis=0))
        parts = [
            start + np.linspace(0, 1, 2 + int(np.abs(step).max() / FINE))[:, None] * step
            for start, step in zip(way, steps, strict=False)
        ]
        free[k] = body.is_free(arena, wrap_angle(np.concatenate(parts))).all() if parts else True
    return free


def joint_length(way: Float[np.ndarray, "postures *ways joints"]) -> np.ndarray:
    """Measure a way from posture to posture, the short way round: the root of the sum of squares, rad."""
    return np.asarray(np.linalg.norm(wrap_angle(np.diff(way, axis=0)), axis=-1).sum(axis=0))


def shortest_joint_ways(
    arena: Arena, body: Body, pairs: Float[np.ndarray, "pairs 2 2"]
) -> Float[np.ndarray, " pairs"]:
    """Measure the shortest ways of a body of two turning joints between pairs of postures, rad.

    Straight where nothing is in between, else by Dijkstra's algorithm on a grid of 2° with 16 directions.

    Parameters
    ----------
    arena, body
        What must not touch what.
    pairs
        Postures (start, goal), rad.

    Raises
    ------
    CogmapError
        For another body, postures that are not finite or not free, and where no way leads.
    """
    if [axis.unit for axis in body.axes] != ["rad", "rad"]:
        raise CogmapError(f"the {type(body).__name__} has not two turning joints; give an arm of two links")
    check_array("pairs", pairs.reshape(-1, 2), (None, 2))
    if not body.is_free(arena, pairs.reshape(-1, 2)).all():
        raise CogmapError("not all postures are free; draw them from free ones")
    lengths = joint_length(pairs.transpose(1, 0, 2))
    bent = np.flatnonzero(~ways_are_free(arena, body, list(pairs)))
    if len(bent):
        graph, middles = _grid(arena, body)
        known = np.flatnonzero(np.diff(graph.indptr))
        ends = [
            known[np.linalg.norm(wrap_angle(middles[known] - pose), axis=1).argmin()]
            for pose in pairs[bent].reshape(-1, 2)
        ]
        starts, goals = np.array(ends).reshape(-1, 2).T
        around = dijkstra(graph, indices=starts)[np.arange(len(bent)), goals]
        lengths[bent] = np.maximum(around, lengths[bent])
    if not np.isfinite(lengths).all():
        raise CogmapError("no way leads between some of the postures; draw both from one part of free space")
    return lengths


def _grid(arena: Arena, body: Body) -> tuple[sp.csr_array, Float[np.ndarray, "cells 2"]]:
    """Join the free cells of the torus of two joints."""
    angles = -np.pi + 2 * np.pi * (np.arange(CELLS) + 0.5) / CELLS
    middles = np.stack(np.meshgrid(angles, angles, indexing="ij"), axis=-1).reshape(-1, 2)
    free = body.is_free(arena, middles).reshape(CELLS, CELLS)
    cells = np.arange(CELLS**2).reshape(CELLS, CELLS)
    edges = []
    for move in MOVES:
        onto, step = np.roll(cells, move, (0, 1)), 2 * np.pi / CELLS * float(np.hypot(*move))
        open_ = free & free.ravel()[onto]
        edges.append((cells[open_], onto[open_], np.full(open_.sum(), step)))
    starts, ends, lengths = (np.concatenate(parts) for parts in zip(*edges, strict=True))
    graph = sp.csr_array((lengths, (starts, ends)), shape=(CELLS**2, CELLS**2))
    return sp.csr_array(graph + graph.T), middles
