"""The scenery: all that does not change while the explorer goes, as a browser draws it."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
import shapely
from contourpy import contour_generator
from jaxtyping import Float

from arena import Arena
from arena.rooms.materials import texture
from arena.smell.odour import FAINTEST
from cogmap.cells import bin_edges, rate_maps
from cogmap.cells.rates.bins import means_by_bin
from cogmap.pages.live.pictures import packed
from cogmap.pages.live.world import World
from cogmap.plots.style import direction_colours

CONTOURS = 6
"""At most of an odour; from one to the next outer one the concentration halves."""
GRID = 0.05
"""Distance (m) at which odours are asked for."""
FIELD_BIN, LATTICE_BIN = 0.1, 0.25
"""Bins of place fields and of the metric map's lattice, m."""
LINKS = 3000
"""Edges of the roadmap that are drawn at most."""

Json = dict[str, Any]


@lru_cache(maxsize=4)
def scenery(world: World) -> Json:
    """Give the room, what the map knows of it laid over it, and the embedding; made once."""
    return {
        "room": room_lines(world.room),
        "radius": world.body.radius,
        "eye": {"width": world.camera.width, "height": world.camera.height},
        "fields": _fields(world),
        "preferred": _preferred(world),
        "charts": _charts(world),
        "metric": _metric(world),
        "roadmap": _roadmap(world),
        "embedding": _embedding(world),
        "replays": list(world.replays or {}),
        "reason": world.mind.reason,
    }


def room_lines(room: Arena) -> Json:
    """Give the room from above: walls, solids, platform, odours."""
    return {
        "name": room.name,
        "bounds": list(room.bounds),
        "platform": [_rounded(ring.coords) for ring in shapely.get_parts(room.walkable.boundary)],
        "walls": [{"ends": [wall.start, wall.end], "colour": _colour(wall.material)} for wall in room.walls],
        "solids": [
            {
                "outline": _rounded(solid.outline),
                "colour": _colour(solid.sides[0]),
                "box": k < len(room.boxes),
            }
            for k, solid in enumerate(room.solids)
        ],
        "sources": [source.position for source in room.sources],
        "odours": _odours(room),
    }


def _odours(room: Arena) -> list[Json]:
    """Give the contours of each odour, and its colour."""
    if not room.sources:
        return []
    x0, y0, x1, y1 = room.bounds
    x, y = (np.linspace(a, b, min(2 + int((b - a) / GRID), 300)) for a, b in ((x0, x1), (y0, y1)))
    points = np.stack(np.meshgrid(x, y), axis=-1)
    odours = room.odours.concentration(points.reshape(-1, 2)).reshape(*points.shape[:2], -1)
    odours = np.where(odours <= FAINTEST * 1.01, np.nan, odours)
    highest = int(np.floor(np.log2(np.nanmax(odours))))
    hues = direction_colours(2 * np.pi * np.arange(len(room.sources)) / len(room.sources))
    drawn = []
    for index, hue in enumerate(hues):
        lines = contour_generator(x, y, np.ma.masked_invalid(odours[:, :, index]))
        levels = [2.0**level for level in range(highest - CONTOURS + 1, highest + 1)]
        found = [_rounded(line) for level in levels for line in lines.lines(level)]
        drawn.append({"colour": _css(hue[:3]), "lines": found})
    return drawn


def _fields(world: World) -> Json:
    """Give the rate maps of the place cells, as bytes of their peaks; 255 is where never visited."""
    rates = np.nan_to_num(world.mind.remembered.place)
    maps = rate_maps(rates, world.sampled_poses[:, :2], bin=FIELD_BIN)
    values = np.asarray(maps)
    peaks = np.nanmax(values, axis=(1, 2))
    shares = values / np.maximum(peaks, 1e-9)[:, None, None]
    shown = np.where(np.isnan(shares), 255, np.round(np.nan_to_num(shares) * 254)).astype(np.uint8)
    x, y = maps.edges.x, maps.edges.y
    return {
        "cells": len(shown),
        "shape": list(shown.shape[1:]),
        "bounds": [float(x[0]), float(y[0]), float(x[-1]), float(y[-1])],
        "peaks": np.round(peaks, 2).tolist(),
        "data": packed(shown),
    }


def _preferred(world: World) -> Json:
    """Give where each place cell fires most, and each heading cell's direction, in the room."""
    rates = np.nan_to_num(world.mind.remembered.place.astype(np.float64))
    strong = rates**4
    places = (strong.T @ world.sampled_poses[:, :2]) / np.maximum(strong.sum(axis=0), 1e-12)[:, None]
    turning = np.nan_to_num(world.mind.remembered.heading.astype(np.float64)).T @ np.exp(
        1j * world.sampled_poses[:, 2]
    )
    return {"place": _rounded(places), "heading": np.round(np.angle(turning), 4).tolist()}


def _charts(world: World) -> list[list[float]]:
    """Give where each chart lies and looks, by what it recalls: x, y, heading."""
    state = world.mind.cmap.state_dict()
    smells, phases = state.get("readout.intercepts"), state.get("readout.phases")
    if smells is None or phases is None or world.map_frame is None:
        return []
    recalled = np.exp(np.clip(smells.cpu().numpy().astype(np.float64).reshape(len(smells), -1), -60, 60))
    there = world.in_room(world.mind.cmap.perceive(odours=recalled).position)
    looks = [world.facing(float(phase)) for phase in phases.cpu().numpy().ravel()]
    return _rounded(np.column_stack([there, looks]))


def _metric(world: World) -> list[list[float]]:
    """Give links (x, y, x, y) of a square lattice of the room as the map bends it."""
    if world.map_frame is None:
        return []
    true = world.sampled_poses[:, :2]
    away = world.in_room(world.mind.remembered.position) - true
    edges = bin_edges(true, LATTICE_BIN)
    ny, nx = edges.shape
    nodes = np.stack(np.meshgrid(*edges.centres), axis=2)
    nodes = nodes + means_by_bin(edges.bin_of(true), ny * nx, away).reshape(ny, nx, 2)
    across = np.concatenate([nodes[:, :-1], nodes[:, 1:]], axis=2).reshape(-1, 4)
    along = np.concatenate([nodes[:-1], nodes[1:]], axis=2).reshape(-1, 4)
    links = np.concatenate([across, along])
    return _rounded(links[np.isfinite(links).all(axis=1)])


def _roadmap(world: World) -> list[list[float]]:
    """Give edges (x, y, x, y) of what ways are planned over."""
    if world.mind.reason or world.map_frame is None:
        return []
    edges = world.mind.imagination.ways.edges
    chosen = edges[np.linspace(0, len(edges) - 1, min(LINKS, len(edges))).astype(int)]
    return _rounded(world.in_room(chosen.reshape(-1, 2)).reshape(-1, 4))


def _embedding(world: World) -> Json:
    """Give the points of the embedding, and the poses by which they are coloured."""
    return {
        "points": packed(world.mind.embedding.astype(np.float32)),
        "poses": packed(world.poses[world.mind.shown].astype(np.float32)),
    }


def _rounded(points: Any) -> list[list[float]]:
    return np.round(np.asarray(points, np.float64), 3).tolist()  # type: ignore[no-any-return]


def _colour(material: str) -> str:
    return _css(texture(material).mean(axis=(0, 1)) / 255)


def _css(colour: Float[np.ndarray, "3"]) -> str:
    return "#" + "".join(f"{round(255 * float(part)):02x}" for part in colour)
