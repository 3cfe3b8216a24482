"""Straight ways through a room."""

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from arena.arena import Arena, Point
from arena.body import TOLERANCE, Body
from arena.errors import ArenaError
from arena.motions.stepping import free_space

_LINES = 81
_NARROW = 1e-3


def corridor(
    arena: Arena, body: Body, room: float, ends: tuple[Point, Point] | None
) -> tuple[Point, Point, float]:
    """Find a straight way between two ends (m) with room (m) on either side for the body.

    Parameters
    ----------
    room
        How much is wanted; half of it where that is too much, or a quarter and so on.
    ends
        None finds the longest way along or across the body's free space, the most central of equals.

    Returns
    -------
    start, end, room
        How much room there is stands last.

    Raises
    ------
    ArenaError
        When the body fits nowhere, or not everywhere between the ends.
    """
    free_space(arena, body)
    while True:
        region = arena.free_space(body.radius + room)
        way = _longest(region) if ends is None else ends
        if way and region.buffer(TOLERANCE).covers(shapely.LineString(way)):
            return *way, room
        if room == 0:
            raise ArenaError(
                f"a body of radius {body.radius:g} m cannot go straight between {ends} m; "
                "choose ends with nothing in the way"
            )
        room = room / 2 if room > _NARROW else 0.0


def _longest(region: BaseGeometry) -> tuple[Point, Point] | None:
    if region.area < 1e-6:
        return None
    a, b, c, d = shapely.get_coordinates(shapely.oriented_envelope(region))[:4]
    offsets = np.linspace(-0.5, 0.5, _LINES)[1:-1, None]
    lines, cost = [], []
    for along, across in ((b - a, c - b), (c - b, b - a)):
        middle = (a + b + c + d) / 4 + offsets * across
        lines.append(np.stack([middle - along / 2, middle + along / 2], axis=1))
        cost.append(0.01 * np.abs(offsets[:, 0]) * np.hypot(*across))
    pieces, line = shapely.get_parts(
        shapely.intersection(shapely.linestrings(np.concatenate(lines)), region), return_index=True
    )
    best = pieces[np.argmax(shapely.length(pieces) - np.concatenate(cost)[line])]
    (x0, y0), (x1, y1) = best.coords[0], best.coords[-1]
    return (x0, y0), (x1, y1)
