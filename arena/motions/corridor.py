"""Corridors: straight ways through a room."""

import math

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from arena.bodies.base import TOLERANCE
from arena.bodies.disc import Disc
from arena.errors import ArenaError
from arena.motions.locomotion import Point, free_space
from arena.rooms.arena import Arena

_LINES = 161
_NARROW = 1e-3


def corridor(
    arena: Arena, body: Disc, room: float, ends: tuple[Point, Point] | None
) -> tuple[Point, Point, float]:
    """Find a straight way between two ends (m) with room (m) on either side for the body.

    Parameters
    ----------
    room
        How much is wanted; half of it where that is too much, or a quarter and so on.
    ends
        None finds the longest way along any side of the platform, the most central of equals.

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
    if ends is not None and math.dist(*ends) < _NARROW:
        raise ArenaError(f"the ends {ends} m are the same place; choose two")
    while True:
        region = arena.free_space(body.radius + room)
        way = _longest(region, arena.platform) if ends is None else ends
        if way and region.buffer(TOLERANCE).covers(shapely.LineString(way)):
            return *way, room
        if room == 0:
            raise ArenaError(
                f"a body of radius {body.radius:g} m cannot go straight between {ends} m; "
                "choose ends with nothing in the way"
            )
        room = room / 2 if room > _NARROW else 0.0


def _longest(region: BaseGeometry, platform: tuple[tuple[Point, ...], ...]) -> tuple[Point, Point] | None:
    if region.area < 1e-6:
        return None
    sides = np.concatenate([np.roll(corners, -1, axis=0) - corners for corners in map(np.array, platform)])
    angles = np.unique((np.arctan2(sides[:, 1], sides[:, 0]) % np.pi).round(6) % np.pi)
    low, high = np.reshape(region.bounds, (2, 2))
    reach = np.hypot(*(high - low)) / 2
    offset = np.linspace(-reach, reach, _LINES)[None, :, None]
    along = np.stack([np.cos(angles), np.sin(angles)], axis=1)[:, None]
    middle = (low + high) / 2 + offset * (along[..., ::-1] * [-1, 1])
    ends = np.stack([middle - reach * along, middle + reach * along], axis=2).reshape(-1, 2, 2)
    inside = shapely.intersection(shapely.linestrings(ends), region)
    pieces, line = shapely.get_parts(inside, return_index=True)
    aside = np.abs(offset).ravel()[line % _LINES]
    best = pieces[np.argmax(shapely.length(pieces) - 0.01 * aside)]
    (x0, y0), (x1, y1) = best.coords[0], best.coords[-1]
    return (x0, y0), (x1, y1)
